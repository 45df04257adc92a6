// Makes an HTML page about a .svdag: pictures, contents, whether it is sound; scene and resources
// of its bake, and verdicts of other commands, where their JSON is given. The page is
// self-contained, so it can be mailed and archived.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/dag/dag_file.h"
#include "io/dag/dag_stats.h"
#include "verify/integrity/integrity.h"
#include "verify/report/embedded_viewer.h"

namespace svdag {

struct ReportPicture {
  std::string caption;
  std::vector<std::byte> png;
};

// JSON about the file: of `svdag build --report`, or a verdict of svdag-verify --json.
struct ReportInput {
  std::string path;
  std::string text;
};

struct ReportPage {
  std::string html;
  bool ok = false;  // the file is sound and no verdict differs
};

// Error, with the path of an input: kBadInput if it is neither a report nor a verdict or is
// incomplete, kUsage if it is about another file, or a second report of a bake.
ReportPage report_html(const std::vector<ReportInput>& inputs, const DagFile& file,
                       const DagStats& stats, const IntegrityReport& integrity,
                       const std::vector<ReportPicture>& pictures,
                       const EmbeddedViewer& viewer = {});

}  // namespace svdag
