// Makes an HTML page about a bake: its scene, pictures, contents, resources, and whether the file
// is sound. The page is self-contained, so it can be mailed and archived.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/dag/dag_file.h"
#include "io/dag/dag_stats.h"
#include "verify/integrity/integrity.h"

namespace svdag {

struct ReportPicture {
  std::string caption;
  std::vector<std::byte> png;
};

// `bake` is the JSON that `svdag build --report` wrote for `file`, read from `path`. Error, with
// `path`: kBadInput if it is not such a report or is incomplete, kUsage if it is that of another
// file.
std::string report_html(const std::string& bake, const std::string& path, const DagFile& file,
                        const DagStats& stats, const IntegrityReport& integrity,
                        const std::vector<ReportPicture>& pictures);

}  // namespace svdag
