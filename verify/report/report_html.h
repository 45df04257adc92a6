// A bake as one page of HTML: what was baked from what, how it looks, what it holds, what it took,
// and whether it is sound. Nothing is loaded from elsewhere, so the page can be mailed and kept.
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

// `bake` is the JSON that `svdag build --report` wrote of `file`. An Error naming `path` if it is
// none, or lacks something (kBadInput), or if it is that of another file (kUsage).
std::string report_html(const std::string& bake, const std::string& path, const DagFile& file,
                        const DagStats& stats, const IntegrityReport& integrity,
                        const std::vector<ReportPicture>& pictures);

}  // namespace svdag
