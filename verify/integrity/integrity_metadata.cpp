// Compares the metadata's JSON with the header (docs/format.md, "Metadata"): field by field, so
// that a defect names its field, then byte for byte, because JSON has many texts for one value.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "io/dag/grid_fields.h"
#include "io/dag/metadata.h"
#include "verify/integrity/integrity.h"

namespace svdag {
namespace {

using nlohmann::json;

json expected_metadata(const Header& h) {
  json nodes = json::array();
  for (uint32_t k = 0; k < h.section_count; ++k) nodes.push_back(h.sections[k].nodes);
  json expected = {{"format", "svdag"},
                   {"version", h.version},
                   {"levels", h.levels},
                   {"resolution", 1U << h.levels},
                   {"rule", rule_name(Rule(h.rule))},
                   {"fraction_bits", h.fraction},
                   {"grid",
                    {{"kind", kind_name(Grid::Kind(h.grid_kind))},
                     {"corner", h.corner},
                     {"voxel_size", h.voxel_size},
                     {"k0", h.k0},
                     {"bounded", h.bounded != 0},
                     {"selection",
                      {h.selection_min[0], h.selection_min[1], h.selection_min[2],
                       h.selection_max[0], h.selection_max[1], h.selection_max[2]}}}},
                   {"voxels", h.voxels},
                   {"nodes", nodes},
                   {"largest_snap", h.largest_snap}};
  if (Grid::Kind(h.grid_kind) == Grid::Kind::kOrigin) expected["grid"]["origin"] = h.origin;
  if (h.layer_kind != 0)
    expected["layers"] = {{"kind", layer_kind_name(LayerKind(h.layer_kind))},
                          {"count", h.layer_count},
                          {"union", h.has_union != 0}};
  if (Layout(h.layout) != Layout::kPlain) expected["layout"] = layout_name(Layout(h.layout));
  if (has_colours(h))
    expected["colours"] = {{"level", h.colour_level},
                           {"error", double(h.colour_error) / kColourErrorUnit},
                           {"count", h.colour_count}};
  if (has_transform(h)) expected["grid"]["transform"] = h.transform;
  return expected;
}

constexpr int kMaxDepth = 2;  // a list inside the grid inside the object

// The beginning of an untrusted text.
std::string beginning(const std::string& text) {
  size_t end = std::min<size_t>(text.size(), 40);
  // No cut inside a UTF-8 character.
  while (end > 0 && end < text.size() && (text[end] & 0xC0) == 0x80) --end;
  return text.substr(0, end) + (end < text.size() ? "..." : "");
}

std::string quoted(const std::string& key) {
  return "\"" + beginning(key) + "\"";
}

// Reports keys that occur twice in one object: readers disagree about which one counts.
class RepeatedKeys {
 public:
  explicit RepeatedKeys(std::vector<std::string>* defects) : defects_(defects) {}

  void on_event(json::parse_event_t event, const json& parsed) {
    if (event == json::parse_event_t::object_start) open_.emplace_back();
    if (event == json::parse_event_t::object_end) open_.pop_back();
    if (event != json::parse_event_t::key) return;
    const std::string key = parsed.get<std::string>();
    if (!open_.back().insert(key).second && reported_.insert(key).second)
      defects_->push_back("the metadata has the key " + quoted(key) + " twice");
  }

 private:
  std::vector<std::set<std::string>> open_;  // keys of the enclosing objects
  std::set<std::string> reported_;
  std::vector<std::string>* defects_;
};

}  // namespace

std::vector<std::string> metadata_defects(const Header& header, std::string_view metadata) {
  std::vector<std::string> defects;
  RepeatedKeys repeated(&defects);
  bool too_deep = false;
  const auto on_event = [&](int depth, json::parse_event_t event, json& parsed) {
    repeated.on_event(event, parsed);
    too_deep = too_deep || depth > kMaxDepth + 1;
    return !too_deep;  // a value that is too deep is dropped: printing it could exhaust the stack
  };
  const json found = json::parse(metadata, on_event, /*allow_exceptions=*/false);
  if (too_deep) return {"the metadata is nested too deep"};
  if (!found.is_object()) return {"the metadata is not a JSON object"};
  const json expected = expected_metadata(header);
  for (const auto& [key, value] : expected.items()) {
    if (!found.contains(key)) {
      defects.push_back("the metadata lacks \"" + key + "\"");
    } else if (found[key] != value) {
      defects.push_back("the metadata says \"" + key + "\" is " +
                        beginning(found[key].dump(-1, ' ', true)) + ", the header " + value.dump());
    }
  }
  for (const auto& [key, value] : found.items()) {
    if (!expected.contains(key))
      defects.push_back("the metadata has an unknown key " + quoted(key));
  }
  if (defects.empty() && metadata != metadata_of(header))
    return {"the metadata is not the exact line that the format requires"};
  return defects;
}

}  // namespace svdag
