#include <nlohmann/json.hpp>

#include "builder/import/import.h"
#include "io/json.h"
#include "io/units.h"

namespace svdag {

std::string layers_text(const ImportReport& report) {
  if (report.layers == 0) return {};
  return ", " + format_count(report.layers, "layer");
}

std::string report_json(const ImportReport& report, const std::string& output) {
  const nlohmann::ordered_json json = {{"output", output},
                                       {"resolution", report.grid.resolution()},
                                       {"levels", report.grid.levels},
                                       {"voxels", report.voxels},
                                       {"layers", report.layers},
                                       {"dag_nodes", report.nodes},
                                       {"file_bytes", report.file_bytes},
                                       {"content_hash", report.content_hash}};
  return json_text(json, 2) + "\n";
}

}  // namespace svdag
