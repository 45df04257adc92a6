// The metadata's JSON against the header, field by field (docs/format.md, "Metadata").
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

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

// A key that may be anything.
std::string quoted(const std::string& key) {
  size_t end = std::min<size_t>(key.size(), 40);
  while (end > 0 && end < key.size() && (key[end] & 0xC0) == 0x80) --end;  // within a character
  return "\"" + key.substr(0, end) + "\"";
}

// Notes keys that come twice in one object: readers disagree about which of them counts.
class RepeatedKeys {
 public:
  explicit RepeatedKeys(std::vector<std::string>* defects) : defects_(defects) {}

  void see(json::parse_event_t event, const json& parsed) {
    if (event == json::parse_event_t::object_start) open_.emplace_back();
    if (event == json::parse_event_t::object_end) open_.pop_back();
    if (event != json::parse_event_t::key) return;
    const std::string key = parsed.get<std::string>();
    if (!open_.back().insert(key).second && told_.insert(key).second)
      defects_->push_back("the metadata has the key " + quoted(key) + " twice");
  }

 private:
  std::vector<std::set<std::string>> open_;  // keys of the objects around
  std::set<std::string> told_;
  std::vector<std::string>* defects_;
};

}  // namespace

std::vector<std::string> metadata_defects(const Header& header, std::string_view metadata) {
  std::vector<std::string> defects;
  RepeatedKeys repeated(&defects);
  const auto see = [&](int, json::parse_event_t event, json& parsed) {
    repeated.see(event, parsed);
    return true;
  };
  const json found = json::parse(metadata, see, /*allow_exceptions=*/false);
  if (!found.is_object()) return {"the metadata is not a JSON object"};
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
      defects.push_back("the metadata has an unknown key " + quoted(key));
  }
  return defects;
}

}  // namespace svdag
