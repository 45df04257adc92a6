#include <cstdio>
#include <nlohmann/json.hpp>

#include "builder/commands/commands.h"
#include "io/json_text.h"
#include "io/scene/mesh_stats.h"
#include "io/units.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

void print_json(const InfoConfig& config, const Box& box, const SceneCounts& counts,
                const MeshStats& stats) {
  const Json json = {{"scene", config.paths},
                     {"triangles", stats.triangles},
                     {"invalid", counts.invalid},
                     {"bounds", {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z}},
                     {"positions", stats.positions},
                     {"repeated_corners", stats.repeated},
                     {"zero_area", stats.zero_area},
                     {"duplicates", stats.duplicates},
                     {"open_edges", stats.open_edges},
                     {"non_manifold_edges", stats.non_manifold_edges},
                     {"components", stats.components}};
  std::printf("%s\n", json_text(json, 2).c_str());
}

void print_text(const InfoConfig& config, const Box& box, const SceneCounts& counts,
                const MeshStats& stats) {
  const auto point = [](const Point& p) {
    return "(" + format_double(p.x) + ", " + format_double(p.y) + ", " + format_double(p.z) + ")";
  };
  std::printf("%s", config.paths.front().c_str());
  if (config.paths.size() > 1) std::printf(" and %zu more", config.paths.size() - 1);
  std::printf(": %s triangles, %s positions, %s components\n",
              format_count(stats.triangles).c_str(), format_count(stats.positions).c_str(),
              format_count(stats.components).c_str());
  std::printf("  bounds %s .. %s\n", point(box.min).c_str(), point(box.max).c_str());
  std::printf(
      "  %s triangles of zero area, %s of them with two equal corners; %s repeated triangles\n",
      format_count(stats.zero_area).c_str(), format_count(stats.repeated).c_str(),
      format_count(stats.duplicates).c_str());
  std::printf("  %s open edges, %s non-manifold edges\n", format_count(stats.open_edges).c_str(),
              format_count(stats.non_manifold_edges).c_str());
  if (counts.invalid > 0)
    std::printf("  %s triangles with NaN or infinity left out\n",
                format_count(counts.invalid).c_str());
}

}  // namespace

void info_scene(const InfoConfig& config) {
  MemoryBudget budget(config.memory != 0 ? config.memory : default_memory_limit());
  const Scene scene({config.paths, config.names, config.skip_invalid, config.sandbox}, &budget);
  SceneCounts counts;
  const Box box = scene.bounds(&counts);
  const MeshStats stats = compute_mesh_stats(scene, &budget);
  config.json ? print_json(config, box, counts, stats) : print_text(config, box, counts, stats);
}

}  // namespace svdag
