#include <nlohmann/json.hpp>

#include "builder/import/import.h"
#include "io/json_text.h"

namespace svdag {

std::string report_json(const ImportReport& report, const std::string& output) {
  const nlohmann::ordered_json json = {{"output", output},
                                       {"resolution", report.grid.resolution()},
                                       {"levels", report.grid.levels},
                                       {"voxels", report.voxels},
                                       {"dag_nodes", report.nodes},
                                       {"file_bytes", report.file_bytes},
                                       {"content_hash", report.content_hash}};
  return json_text(json, 2) + "\n";
}

}  // namespace svdag
