#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "builder/commands/command_scene.h"
#include "builder/commands/commands.h"
#include "builder/split/open_edges.h"
#include "io/json.h"
#include "io/lattice.h"
#include "io/scene/boundary_chain.h"
#include "io/scene/cutouts/cut_records.h"
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
  double area = 0, opaque = 0;  // of the triangles; of their opaque points

  double opaque_share() const { return area > 0 ? opaque / area : 1; }
};

// The share of a triangle that its material does not cut out, by the middles of 16 equal parts.
double opaque_share(const CutOut& cut, const TextureCorners& corners) noexcept {
  constexpr int kDivisions = 4;
  int opaque = 0;
  // In the parallelogram (i, j) of b and c, one part is below its diagonal and one above.
  for (int i = 0; i < kDivisions; ++i) {
    for (int j = 0; j + i < kDivisions; ++j) {
      for (const double middle : {1.0 / 3, 2.0 / 3}) {
        const double b = (i + middle) / kDivisions, c = (j + middle) / kDivisions;
        if (b + c >= 1) continue;
        const auto at = [&](double TexturePoint::*axis) {
          return corners[0].*axis * (1 - b - c) + corners[1].*axis * b + corners[2].*axis * c;
        };
        opaque += alpha_at(cut, {at(&TexturePoint::u), at(&TexturePoint::v)}) >= cut.threshold;
      }
    }
  }
  return double(opaque) / (kDivisions * kDivisions);
}

// Counts the memory of the list of parts, in steps.
class PartsMemory {
 public:
  // JSON: a text of each part is made as well.
  PartsMemory(MemoryBudget* budget, bool json) : reservation_(budget, 0), json_(json) {}
  void add(const std::string& name) {
    // Measured: 240 bytes for each part in the list and its index, 610 for its JSON.
    needed_ += 240 + 2 * name.size() + (json_ ? 640 + 2 * name.size() : 0);
    if (needed_ > reservation_.bytes()) reservation_.resize(needed_ + kStep, "parts");
  }

 private:
  static constexpr uint64_t kStep = 1 << 20;
  MemoryBudget::Reservation reservation_;
  uint64_t needed_ = 0;
  bool json_;
};

// The objects in order of appearance, then the materials, then the files.
std::vector<MeshPart> list_parts(const Scene& scene, PartsMemory* memory) {
  std::vector<MeshPart> parts;
  std::map<std::pair<PartKind, std::string>, size_t> index_of;
  CutOuts cut_outs;
  scene.stream([&](const TriangleBatch& batch) {
    Box bounds;
    double area = 0, opaque = 0;
    const CutOut* const cut =
        batch.cut == nullptr ? nullptr : &cut_outs[material_number(*batch.cut, &cut_outs)];
    for (size_t i = 0; i < batch.triangles.size(); ++i) {
      const auto& [a, b, c] = batch.triangles[i].v;
      const double of_triangle = glm::length(glm::cross(b - a, c - a)) / 2;
      bounds.add(batch.triangles[i]);
      area += of_triangle;
      opaque += cut == nullptr ? of_triangle : of_triangle * opaque_share(*cut, batch.texture[i]);
    }
    const auto add = [&](PartKind kind, std::string_view name) {
      const auto [at, added] = index_of.emplace(std::pair(kind, name), parts.size());
      if (added) {
        memory->add(at->first.second);
        parts.push_back({kind, std::string(name), 0, {}});
      }
      MeshPart& part = parts[at->second];
      part.triangles += batch.triangles.size();
      part.bounds.add(bounds);
      part.area += area;
      part.opaque += opaque;
    };
    add(PartKind::kObject, batch.mesh);
    if (!batch.material.empty()) add(PartKind::kMaterial, batch.material);
    add(PartKind::kFile, batch.file);
  });
  std::stable_sort(parts.begin(), parts.end(),
                   [](const MeshPart& a, const MeshPart& b) { return a.kind < b.kind; });
  return parts;
}

constexpr int kSnapLevels = 16;  // grids from 64K^3 on have the finest lattice

// Whether rule solid can bake the scene, at 64K^3.
struct Closedness {
  bool is_known = false;  // false for a scene without a grid: of no extent, or of denormals
  OpenEdges open;
  double volume = 0;  // that the surface winds around, signed, in cubic units of the scene

  bool is_closed() const { return open.edges == 0; }
};

Closedness closedness_of(const Scene& scene, const Box& box) {
  Closedness result;
  const Point side = box.max - box.min;
  const double voxel = std::max({side.x, side.y, side.z}) / ((1 << kSnapLevels) - 1);
  if (!std::isnormal(voxel)) return result;
  const Grid grid = divide_box(box, kSnapLevels);
  const Lattice lattice(grid);
  EdgeSum edges;
  scene.stream([&](const TriangleBatch& batch) {
    for (const Triangle& t : batch.triangles) {
      const Point a = t.v[0] - box.min, b = t.v[1] - box.min, c = t.v[2] - box.min;
      result.volume += glm::dot(a, glm::cross(b, c)) / 6;
      edges.add({{lattice.snap(t.v[0]), lattice.snap(t.v[1]), lattice.snap(t.v[2])}});
    }
  });
  if (!edges.is_closed()) result.open = find_open_edges(scene, grid);
  result.is_known = true;
  return result;
}

Json bounds_json(const Box& box) {
  return {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
}

void print_json(const InfoCommand& config, const Box& box, const SceneCounts& counts,
                const MeshStats& stats, const Closedness& closed,
                const std::vector<Animation>& animations, const std::vector<MeshPart>& parts) {
  Json json = {{"scene", config.scene.paths},
               {"triangles", stats.triangles},
               {"invalid", counts.invalid},
               {"cut", counts.cut},
               {"undeformed", counts.undeformed},
               {"left_out", left_out_json(counts.left_out)},
               {"units", counts.units},
               {"bounds", bounds_json(box)},
               {"positions", stats.positions},
               {"repeated_corners", stats.repeated},
               {"zero_area", stats.zero_area},
               {"duplicates", stats.duplicates},
               {"open_edges", stats.open_edges},
               {"non_manifold_edges", stats.non_manifold_edges},
               {"components", stats.components},
               {"closed", nullptr},
               {"closed_without_orientation", nullptr},
               {"volume", nullptr},
               {"animations", Json::array()}};
  if (closed.is_known) {
    json["closed"] = closed.is_closed();
    json["closed_without_orientation"] = closed.is_closed() || closed.open.closed_mod_2;
    if (closed.is_closed()) json["volume"] = closed.volume;
  }
  for (const auto& [name, seconds, nodes, weights] : animations)
    json["animations"].push_back(
        {{"name", name}, {"seconds", seconds}, {"nodes", nodes}, {"weights", weights}});
  for (const MeshPart& part : parts)
    json["parts"].push_back({{"kind", name_of(part.kind)},
                             {"name", part.name},
                             {"triangles", part.triangles},
                             {"bounds", bounds_json(part.bounds)},
                             {"opaque", part.opaque_share()}});
  std::printf("%s\n", json_text(json, 2).c_str());
}

void print_closedness(const Closedness& closed) {
  if (!closed.is_known) return;
  if (closed.is_closed()) {
    std::printf("  closed at 64K^3, encloses %.6g cubic units\n", closed.volume);
  } else if (closed.open.closed_mod_2) {
    std::printf("  closed at 64K^3, but not oriented alike at %s\n", describe(closed.open).c_str());
  } else {
    std::printf("  not closed at 64K^3: %s\n", describe(closed.open).c_str());
  }
}

void print_text(const InfoCommand& config, const Box& box, const SceneCounts& counts,
                const MeshStats& stats, const Closedness& closed,
                const std::vector<Animation>& animations, const std::vector<MeshPart>& parts) {
  std::printf("%s", printable(config.scene.paths.front()).c_str());
  if (config.scene.paths.size() > 1) std::printf(" and %zu more", config.scene.paths.size() - 1);
  std::printf(": %s, %s, %s\n", format_count(stats.triangles, "triangle").c_str(),
              format_count(stats.positions, "position").c_str(),
              format_count(stats.components, "component").c_str());
  std::printf("  bounds %s .. %s\n", format_point(box.min).c_str(), format_point(box.max).c_str());
  for (const double unit : counts.units) std::printf("  unit %s m\n", format_double(unit).c_str());
  std::printf(
      "  %s triangles of zero area, %s of them with two equal corners; %s repeated triangles\n",
      format_count(stats.zero_area).c_str(), format_count(stats.repeated).c_str(),
      format_count(stats.duplicates).c_str());
  std::printf("  %s open edges, %s non-manifold edges\n", format_count(stats.open_edges).c_str(),
              format_count(stats.non_manifold_edges).c_str());
  print_closedness(closed);
  if (counts.invalid > 0)
    std::printf("  %s triangles with NaN or infinity dropped\n",
                format_count(counts.invalid).c_str());
  print_scene_notes(counts);
  for (size_t i = 0; i < animations.size(); ++i) {
    const auto& [name, seconds, nodes, weights] = animations[i];
    std::printf("  animation #%zu%s%s: %.6g s, moves %s, morphs %s\n", i, name.empty() ? "" : " ",
                printable(name).c_str(), seconds, format_count(nodes, "node").c_str(),
                format_count(weights).c_str());
  }
  if (config.parts) std::printf("\n  %14s  part\n", "triangles");
  for (const MeshPart& part : parts) {
    std::printf("  %14s  %s:%s  %s .. %s", format_count(part.triangles).c_str(), name_of(part.kind),
                part.name.empty() ? "(unnamed)" : printable(part.name).c_str(),
                format_point(part.bounds.min).c_str(), format_point(part.bounds.max).c_str());
    if (part.opaque < part.area) std::printf(", %.1f %% opaque", 100 * part.opaque_share());
    std::printf("\n");
  }
}

}  // namespace

void info_scene(const InfoCommand& config) {
  MemoryBudget budget(memory_or_default(config.memory));
  const Scene scene(config.scene, &budget);
  SceneCounts counts;
  const Box box = scene.bounds(&counts);
  const MeshStats stats = compute_mesh_stats(scene, &budget);
  PartsMemory memory(&budget, config.json);
  const auto parts = config.parts ? list_parts(scene, &memory) : std::vector<MeshPart>();
  const Closedness closed = closedness_of(scene, box);
  const std::vector<Animation> animations = scene.animations();
  config.json ? print_json(config, box, counts, stats, closed, animations, parts)
              : print_text(config, box, counts, stats, closed, animations, parts);
}

}  // namespace svdag
