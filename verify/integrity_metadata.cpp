// The metadata's JSON against the header, field by field (docs/format.md, "Metadata").
#include <nlohmann/json.hpp>

#include "verify/integrity.h"

namespace svdag {
namespace {

using nlohmann::json;

json expected_metadata(const Header& h) {
  json nodes = json::array();
  for (uint32_t k = 0; k < h.section_count; ++k) nodes.push_back(h.sections[k].nodes);
  return {{"format", "svdag"},
          {"version", h.version},
          {"levels", h.levels},
          {"resolution", 1U << h.levels},
          {"rule", h.rule == uint32_t(Rule::kThin) ? "thin" : "conservative"},
          {"fraction_bits", h.fraction},
          {"grid",
           {{"kind", h.grid_kind == 0 ? "box" : "lattice"},
            {"corner", h.corner},
            {"voxel_size", h.voxel_size},
            {"k0", h.k0},
            {"bounded", h.bounded != 0},
            {"selection",
             {h.selection_min[0], h.selection_min[1], h.selection_min[2], h.selection_max[0],
              h.selection_max[1], h.selection_max[2]}}}},
          {"voxels", h.voxels},
          {"nodes", nodes},
          {"largest_snap", h.largest_snap}};
}

}  // namespace

std::vector<std::string> metadata_defects(const Header& header, std::string_view metadata) {
  const json found = json::parse(metadata, nullptr, /*allow_exceptions=*/false);
  if (!found.is_object()) return {"the metadata is not a JSON object"};
  std::vector<std::string> defects;
  const json expected = expected_metadata(header);
  for (const auto& [key, value] : expected.items()) {
    if (!found.contains(key)) {
      defects.push_back("the metadata lacks \"" + key + "\"");
    } else if (found[key] != value) {
      defects.push_back("the metadata says \"" + key + "\" is " + found[key].dump() +
                        ", the header " + value.dump());
    }
  }
  for (const auto& [key, value] : found.items()) {
    if (!expected.contains(key))
      defects.push_back("the metadata has an unknown key \"" + key + "\"");
  }
  return defects;
}

}  // namespace svdag
