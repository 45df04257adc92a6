#include <cstdio>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "builder/commands/commands.h"
#include "builder/commands/scene_notes.h"
#include "io/json_text.h"
#include "io/scene/mesh_stats.h"
#include "io/units.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

// Name and triangle count of each mesh part, in order of appearance.
using MeshParts = std::vector<std::pair<std::string, uint64_t>>;

MeshParts list_parts(const Scene& scene) {
  MeshParts parts;
  std::unordered_map<std::string, size_t> index_of;
  scene.stream([&](const TriangleBatch& batch) {
    const auto [at, added] = index_of.emplace(batch.mesh, parts.size());
    if (added) parts.emplace_back(batch.mesh, 0);
    parts[at->second].second += batch.triangles.size();
  });
  return parts;
}

void print_json(const InfoCommand& config, const Box& box, const SceneCounts& counts,
                const MeshStats& stats, const MeshParts& parts) {
  Json json = {{"scene", config.paths},
               {"triangles", stats.triangles},
               {"invalid", counts.invalid},
               {"undeformed", counts.undeformed},
               {"bounds", {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z}},
               {"positions", stats.positions},
               {"repeated_corners", stats.repeated},
               {"zero_area", stats.zero_area},
               {"duplicates", stats.duplicates},
               {"open_edges", stats.open_edges},
               {"non_manifold_edges", stats.non_manifold_edges},
               {"components", stats.components}};
  for (const auto& [name, triangles] : parts)
    json["parts"].push_back({{"name", name}, {"triangles", triangles}});
  std::printf("%s\n", json_text(json, 2).c_str());
}

void print_text(const InfoCommand& config, const Box& box, const SceneCounts& counts,
                const MeshStats& stats, const MeshParts& parts) {
  std::printf("%s", config.paths.front().c_str());
  if (config.paths.size() > 1) std::printf(" and %zu more", config.paths.size() - 1);
  std::printf(": %s triangles, %s positions, %s components\n",
              format_count(stats.triangles).c_str(), format_count(stats.positions).c_str(),
              format_count(stats.components).c_str());
  std::printf("  bounds %s .. %s\n", format_point(box.min).c_str(), format_point(box.max).c_str());
  std::printf(
      "  %s triangles of zero area, %s of them with two equal corners; %s repeated triangles\n",
      format_count(stats.zero_area).c_str(), format_count(stats.repeated).c_str(),
      format_count(stats.duplicates).c_str());
  std::printf("  %s open edges, %s non-manifold edges\n", format_count(stats.open_edges).c_str(),
              format_count(stats.non_manifold_edges).c_str());
  if (counts.invalid > 0)
    std::printf("  %s triangles with NaN or infinity dropped\n",
                format_count(counts.invalid).c_str());
  print_scene_notes(counts);
  if (config.parts) std::printf("\n  %14s  part\n", "triangles");
  for (const auto& [name, triangles] : parts)
    std::printf("  %14s  %s\n", format_count(triangles).c_str(),
                name.empty() ? "(no name)" : printable(name).c_str());
}

}  // namespace

void info_scene(const InfoCommand& config) {
  MemoryBudget budget(memory_or_default(config.memory));
  const Scene scene({config.paths, config.names, config.skip_invalid, config.sandbox}, &budget);
  SceneCounts counts;
  const Box box = scene.bounds(&counts);
  const MeshStats stats = compute_mesh_stats(scene, &budget);
  const MeshParts parts = config.parts ? list_parts(scene) : MeshParts();
  config.json ? print_json(config, box, counts, stats, parts)
              : print_text(config, box, counts, stats, parts);
}

}  // namespace svdag
