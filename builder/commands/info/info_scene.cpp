#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
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

struct MeshPart {
  PartKind kind;
  std::string name;
  uint64_t triangles = 0;
  Box bounds;
};

// The objects in order of appearance, then the materials, then the files.
std::vector<MeshPart> list_parts(const Scene& scene) {
  std::vector<MeshPart> parts;
  std::map<std::pair<PartKind, std::string>, size_t> index_of;
  scene.stream([&](const TriangleBatch& batch) {
    Box bounds;
    for (const Triangle& t : batch.triangles) bounds.add(t);
    const auto add = [&](PartKind kind, std::string_view name) {
      const auto [at, added] = index_of.emplace(std::pair(kind, name), parts.size());
      if (added) parts.push_back({kind, std::string(name), 0, {}});
      parts[at->second].triangles += batch.triangles.size();
      parts[at->second].bounds.add(bounds);
    };
    add(PartKind::kObject, batch.mesh);
    if (!batch.material.empty()) add(PartKind::kMaterial, batch.material);
    add(PartKind::kFile, batch.file);
  });
  std::stable_sort(parts.begin(), parts.end(),
                   [](const MeshPart& a, const MeshPart& b) { return a.kind < b.kind; });
  return parts;
}

Json bounds_json(const Box& box) {
  return {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
}

void print_json(const InfoCommand& config, const Box& box, const SceneCounts& counts,
                const MeshStats& stats, const std::vector<MeshPart>& parts) {
  Json json = {{"scene", config.scene.paths},
               {"triangles", stats.triangles},
               {"invalid", counts.invalid},
               {"undeformed", counts.undeformed},
               {"bounds", bounds_json(box)},
               {"positions", stats.positions},
               {"repeated_corners", stats.repeated},
               {"zero_area", stats.zero_area},
               {"duplicates", stats.duplicates},
               {"open_edges", stats.open_edges},
               {"non_manifold_edges", stats.non_manifold_edges},
               {"components", stats.components}};
  for (const MeshPart& part : parts)
    json["parts"].push_back({{"kind", name_of(part.kind)},
                             {"name", part.name},
                             {"triangles", part.triangles},
                             {"bounds", bounds_json(part.bounds)}});
  std::printf("%s\n", json_text(json, 2).c_str());
}

void print_text(const InfoCommand& config, const Box& box, const SceneCounts& counts,
                const MeshStats& stats, const std::vector<MeshPart>& parts) {
  std::printf("%s", config.scene.paths.front().c_str());
  if (config.scene.paths.size() > 1) std::printf(" and %zu more", config.scene.paths.size() - 1);
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
  for (const auto& [kind, name, triangles, bounds] : parts)
    std::printf("  %14s  %s%s  %s .. %s\n", format_count(triangles).c_str(),
                (std::string(name_of(kind)) + ":").c_str(),
                name.empty() ? "(no name)" : printable(name).c_str(),
                format_point(bounds.min).c_str(), format_point(bounds.max).c_str());
}

}  // namespace

void info_scene(const InfoCommand& config) {
  MemoryBudget budget(memory_or_default(config.memory));
  const Scene scene(config.scene, &budget);
  SceneCounts counts;
  const Box box = scene.bounds(&counts);
  const MeshStats stats = compute_mesh_stats(scene, &budget);
  const auto parts = config.parts ? list_parts(scene) : std::vector<MeshPart>();
  config.json ? print_json(config, box, counts, stats, parts)
              : print_text(config, box, counts, stats, parts);
}

}  // namespace svdag
