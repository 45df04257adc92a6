#include "verify/view/page.h"

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "io/dag/walk/occupied_bounds.h"
#include "streaming/file/checksum.h"
#include "streaming/file/file.h"

namespace svdag {
namespace {

// The smallest box that holds every voxel that the page can show.
VoxelBox shown_bounds(const DagFile& file) {
  if (file.layers().has_union) return occupied_bounds(file.view());
  VoxelBox all;
  for (size_t i = 0; i < file.layers().layers.size(); ++i) {
    const VoxelBox one = occupied_bounds(file.view_of(i));
    if (one.empty()) continue;
    all = all.empty() ? one : VoxelBox{glm::min(all.min, one.min), glm::max(all.max, one.max)};
  }
  return all;
}

}  // namespace

std::string scene_json(const DagFile& file, const TileCutter& cutter, const SceneOfPage& options) {
  using Json = nlohmann::ordered_json;
  const DagView& dag = file.view();
  const std::string& path = file.path();
  const VoxelBox bounds = shown_bounds(file);
  Json layers = Json::array();
  for (const Layer& layer : file.layers().layers)
    layers.push_back({{"name", shown_layer(layer.name)},
                      {"colour", {layer.colour.r, layer.colour.g, layer.colour.b}},
                      {"voxels", layer.voxels}});
  Json scene = {
      {"name", base_name(path)},
      {"content_hash", to_hex(file.header().content_hash)},
      {"levels", dag.levels},
      {"shown_levels", cutter.levels()},
      {"tile_levels", cutter.tile_levels()},
      {"root", options.root},
      {"up", options.up},
      {"served", options.served},
      {"rule", rule_name(file.rule())},
      {"voxels", file.header().voxels},
      {"corner", dag.corner},
      {"voxel_size", dag.voxel_size},
      {"bounds",
       {{bounds.min.x, bounds.min.y, bounds.min.z}, {bounds.max.x, bounds.max.y, bounds.max.z}}},
      {"layers", layers},
  };
  if (options.colour_level > 0)
    scene["colours"] = {{"level", options.colour_level},
                        {"max", options.max_colours},
                        {"root_only", options.root_colours}};
  const std::string text = scene.dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string safe;
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe + "\n";
}

std::string joined_scripts() {
  std::string joined;
  for (const char* const name : {"camera.js", "tiles.js", "trace.js", "view.js"}) {
    for (const PageFile& file : page_files()) {
      if (file.name != name) continue;
      for (std::string_view left = file.text; !left.empty();) {
        std::string_view line = left.substr(0, left.find('\n') + 1);
        left.remove_prefix(line.size());
        if (line.starts_with("import ")) continue;
        if (line.starts_with("export ")) line.remove_prefix(7);
        joined += line;
      }
    }
  }
  return joined;
}

}  // namespace svdag
