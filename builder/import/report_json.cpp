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
  nlohmann::ordered_json json = {{"output", output},
                                 {"resolution", report.grid.resolution()},
                                 {"levels", report.grid.levels},
                                 {"voxels", report.voxels},
                                 {"layers", report.layers},
                                 {"dag_nodes", report.nodes},
                                 {"file_bytes", report.file_bytes},
                                 {"content_hash", report.content_hash}};
  if (report.points > 0) {
    json["points"] = report.points;
    json["points_left_out"] = report.points_left_out;
  }
  return json_text(json, 2) + "\n";
}

}  // namespace svdag
