#include "io/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "io/scene/decoders/gzip.h"
#include "io/scene/scene_formats.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/file/file_folder.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

bool finite(const Triangle& t) {
  for (const Point& p : t.v) {
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) return false;
  }
  return true;
}

// True only if all are finite, without a branch per number: NaN and infinity persist in a sum. A
// sum of finite numbers may overflow, so `false` decides nothing.
bool surely_finite(std::span<const Triangle> triangles) {
  Point sum(0);
  for (const Triangle& t : triangles) {
    for (int a = 0; a < 3; ++a) sum[a] += (t.v[0][a] + t.v[1][a]) + t.v[2][a];
  }
  return std::isfinite((sum.x + sum.y) + sum.z);
}

// A filter between a reader and the user's sink that rejects triangles with NaN or infinity.
class FiniteFilter {
 public:
  FiniteFilter(const std::string& path, std::string_view frame, const SceneConfig& config,
               const TriangleSink& sink, SceneCounts* counts)
      : path_(path),
        name_(base_name(path)),
        frame_(frame),
        config_(config),
        sink_(sink),
        counts_(counts) {}

  void operator()(const TriangleBatch& batch) {
    check_interrupt();
    if (surely_finite(batch.triangles)) return pass(batch);
    const auto bad = std::find_if_not(batch.triangles.begin(), batch.triangles.end(), finite);
    if (bad == batch.triangles.end()) return pass(batch);
    if (!config_.skip_invalid) refuse(batch, batch.first + size_t(bad - batch.triangles.begin()));
    kept_.clear();
    texture_.clear();
    corner_colours_.clear();
    for (size_t i = 0; i < batch.triangles.size(); ++i) {
      if (!finite(batch.triangles[i])) continue;
      kept_.push_back(batch.triangles[i]);
      if (!batch.texture.empty()) texture_.push_back(batch.texture[i]);
      if (!batch.corner_colours.empty()) corner_colours_.push_back(batch.corner_colours[i]);
    }
    counts_->invalid += batch.triangles.size() - kept_.size();
    TriangleBatch kept = batch;
    kept.triangles = kept_;
    kept.texture = texture_;
    kept.corner_colours = corner_colours_;
    pass(kept);
  }

 private:
  void pass(const TriangleBatch& unnamed) {
    TriangleBatch batch = unnamed;
    batch.file = name_;
    batch.frame = frame_;
    if (config_.only && part_name(batch, config_.only->first) != config_.only->second) return;
    counts_->triangles += batch.triangles.size();
    if (batch.cut != nullptr) counts_->cut += batch.triangles.size();
    if (batch.undeformed) counts_->undeformed += batch.triangles.size();
    counts_->quantisation = std::max(counts_->quantisation, batch.quantisation);
    if (!batch.triangles.empty()) sink_(batch);
  }
  [[noreturn]] void refuse(const TriangleBatch& batch, uint64_t index) const {
    const std::string mesh = batch.mesh.empty() ? "" : " of \"" + std::string(batch.mesh) + "\"";
    fail_input(path_, "triangle " + std::to_string(index) + mesh +
                          " has a coordinate that is NaN or infinite (--skip-invalid drops such "
                          "triangles)");
  }

  const std::string& path_;
  std::string name_;
  std::string_view frame_;
  const SceneConfig& config_;
  const TriangleSink& sink_;
  SceneCounts* counts_;
  std::vector<Triangle> kept_;
  std::vector<TextureCorners> texture_;
  std::vector<CornerColours> corner_colours_;
};

// A sink that passes triangles on in the world, the outside of a mesh still outside.
class ToWorld {
 public:
  ToWorld(const Affine& to_world, const TriangleSink& sink)
      : to_world_(to_world),
        mirror_(is_mirror(to_world)),
        stretch_(axis_stretch(to_world)),
        sink_(sink) {}

  void operator()(const TriangleBatch& batch) {
    placed_.clear();
    for (const Triangle& t : batch.triangles) {
      const Point a = to_world_(t.v[0]), b = to_world_(t.v[1]), c = to_world_(t.v[2]);
      placed_.push_back(mirror_ ? Triangle{{a, c, b}} : Triangle{{a, b, c}});
    }
    TriangleBatch placed = batch;
    placed.triangles = placed_;
    if (mirror_) {
      placed.texture = mirrored(batch.texture, &texture_);
      placed.corner_colours = mirrored(batch.corner_colours, &corner_colours_);
    }
    placed.quantisation *= stretch_;
    sink_(placed);
  }

 private:
  // The corners of triangles of which two change places, in *swapped.
  template <class Corners>
  static std::span<const Corners> mirrored(std::span<const Corners> all,
                                           std::vector<Corners>* swapped) {
    swapped->assign(all.begin(), all.end());
    for (Corners& corners : *swapped) std::swap(corners[1], corners[2]);
    return *swapped;
  }

  Affine to_world_;
  bool mirror_;
  double stretch_;
  const TriangleSink& sink_;
  std::vector<Triangle> placed_;
  std::vector<TextureCorners> texture_;
  std::vector<CornerColours> corner_colours_;
};

// Appends "--include 'sky*'" for patterns that matched no `subject`; if not `allowed`, an Error.
void append_unmatched(const char* option, const char* subject,
                      const std::vector<std::string>& patterns, const std::vector<bool>& used,
                      const NameFilter::Use& use, bool allowed, std::vector<std::string>* out) {
  for (size_t i = 0; i < patterns.size(); ++i) {
    if (used[i]) continue;
    out->push_back(std::string(option) + " '" + patterns[i] + "'");
    if (allowed) continue;
    const std::string near = nearest_names(patterns[i], use);
    fail_usage(out->back() + " matches " + subject + ": " +
               (near.empty() ? "the scene has no names" : "the nearest names are " + near) +
               " (--allow-empty goes on)");
  }
}

LinearImages::Detail detail_of(const SceneConfig& config) {
  if (config.keep_images) return LinearImages::Detail::kKept;
  return config.paint ? LinearImages::Detail::kWhole : LinearImages::Detail::kThumbnails;
}

}  // namespace

Scene::Scene(SceneConfig config, MemoryBudget* budget, const SpillSpace* spill)
    : config_(std::move(config)),
      budget_(budget),
      spill_(spill),
      alpha_(budget, config_.sandbox),
      images_(budget, config_.sandbox, detail_of(config_)) {}

const File& Scene::content_of(const File& packed) const {
  if (!is_gzip(packed)) return packed;
  const auto found = unpacked_.find(packed.path());
  if (found != unpacked_.end()) return found->second;
  File content = create_unpacked(packed.path(), spill_);
  const std::string folder = unpack_folder_of(spill_);
  const uint64_t free = free_bytes_of(folder);
  unpack_gzip(packed, &content, {folder, free - free / 16});  // other programs need some
  return unpacked_.emplace(packed.path(), std::move(content)).first->second;
}

SceneCounts Scene::stream(const TriangleSink& sink) const {
  return read(sink, nullptr);
}

LeftOut Scene::read_pose(const PoseTime* time, std::string_view frame, const NameFilter& names,
                         const TriangleSink& sink, MeshBox* box_alone, SceneCounts* counts) const {
  LeftOut left_out;
  // The means of materials, which take a look at texture coordinates, are not for the box.
  const bool needs_colours = config_.colours && (config_.paint || box_alone == nullptr);
  const Affine to_world = config_.to_world();
  for (const std::string& path : config_.paths) {
    const std::string name = base_name(path);
    const bool by_name = !names.include.empty() && names.includes(PartKind::kFile, name);
    if (names.excludes(PartKind::kFile, name)) continue;
    File packed = File::open_read(path);
    if (hashes_ != nullptr) packed.hash_reads(&(*hashes_)[path]);
    const File& file = content_of(packed);
    FiniteFilter filter(path, frame, config_, sink, counts);
    const TriangleSink filtered = std::ref(filter);
    ReadOptions options{&names,
                        by_name,
                        budget_,
                        spill_,
                        box_alone,
                        config_.sandbox,
                        needs_colours ? &images_ : nullptr,
                        config_.allow_outside,
                        config_.hidden,
                        time};
    double unit = 0;
    options.unit_metres = &unit;
    options.alpha = config_.cut_outs ? &alpha_ : nullptr;
    options.paints = config_.paint ? &images_ : nullptr;
    if (time != nullptr && detect_format(file).read != read_gltf)
      fail_usage(path + (frame.empty() ? ": --time" : ": --frames") +
                 ": svdag follows only animations of glTF");
    if (config_.only) options.box_alone = nullptr;
    if (to_world == Affine()) {
      left_out += read_scene_file(detect_format(file), file, options, filtered);
    } else {
      options.box_alone = nullptr;  // it would hold coordinates of the file, not of the world
      left_out += read_scene_file(detect_format(file), file, options, ToWorld(to_world, filtered));
    }
    if (unit != 0 && std::ranges::find(counts->units, unit) == counts->units.end())
      counts->units.push_back(unit);
  }
  return left_out;
}

SceneCounts Scene::read(const TriangleSink& sink, MeshBox* box_alone) const {
  SceneCounts counts;
  NameFilter names = config_.names;
  NameFilter::Use use{std::vector<bool>(names.include.size()),
                      std::vector<bool>(names.exclude.size()),
                      {},
                      std::vector<bool>(names.cut_out.size())};
  names.use = &use;
  const auto read_at = [&](std::optional<double> seconds, std::string_view frame) {
    const PoseTime time{seconds.value_or(0), config_.animation};
    counts.left_out = read_pose(seconds ? &time : nullptr, frame, names, sink, box_alone, &counts);
  };
  if (config_.frames.empty()) read_at(config_.time, "");
  const bool one = config_.only && config_.only->first == PartKind::kFrame;
  for (uint32_t i = 0; i < config_.frames.count; ++i) {
    const std::string frame = config_.frames.name(i);
    if (!one || config_.only->second == frame) read_at(parse_time(frame), frame);
  }
  const bool allowed = config_.allow_unmatched;
  append_unmatched("--include", "nothing", names.include, use.include, use, allowed,
                   &counts.unmatched);
  append_unmatched("--exclude", "nothing", names.exclude, use.exclude, use, allowed,
                   &counts.unmatched);
  std::erase_if(use.names, [](const auto& name) { return name.second != PartKind::kMaterial; });
  append_unmatched("--cutout", "no material of a glTF or OBJ file", names.cut_out, use.cut_out, use,
                   allowed, &counts.unmatched);
  counts.unread_images = images_.notes();
  return counts;
}

Box Scene::bounds(SceneCounts* counts) const {
  Box box;
  const auto grow = [&](const TriangleBatch& batch) {
    Box grown = box;  // a copy that stays in registers
    for (const Triangle& t : batch.triangles) grown.add(t);
    box = grown;
  };
  MeshBox unread;
  SceneCounts seen = read(grow, &unread);
  seen.triangles += unread.triangles;
  box.add(unread.box);
  if (counts != nullptr) *counts = seen;
  if (box.empty()) fail_empty(seen);
  return box;
}

std::vector<Animation> Scene::animations() const {
  std::vector<Animation> all;
  for (const std::string& path : config_.paths) {
    if (config_.names.excludes(PartKind::kFile, base_name(path))) continue;
    const File packed = File::open_read(path);
    const File& file = content_of(packed);
    const SceneFormat& format = detect_format(file);
    if (format.animations == nullptr) continue;
    std::ranges::move(
        format.animations(file, {.budget = budget_, .spill = spill_, .sandbox = config_.sandbox}),
        std::back_inserter(all));
  }
  return all;
}

void Scene::fail_empty(const SceneCounts& counts) const {
  std::string why;
  for (const std::string& pattern : counts.unmatched) why += "; nothing matches " + pattern;
  for (size_t i = 0; i < kOmissionCount; ++i) {
    if (counts.left_out[i] > 0) why += "; " + omission_text(i, counts.left_out[i]);
  }
  for (const std::string& path : config_.paths) {
    const File packed = File::open_read(path);
    const File& file = content_of(packed);
    const SceneFormat& format = detect_format(file);
    if (format.holds_only_points != nullptr && format.holds_only_points(file))
      why += "; " + base_name(path) +
             " holds only points, which svdag import takes; for triangles, reconstruct a surface";
  }
  fail_input(config_.paths.front(), "the scene has no triangles to bake" + why);
}

InputWatch Scene::watch() const {
  InputWatch watch;
  visit_files([&](const File& file) { watch.add_reopened(file); });
  return watch;
}

void Scene::visit_files(const VisitFile& visit) const {
  for (const std::string& path : config_.paths) {
    if (config_.names.excludes(PartKind::kFile, base_name(path))) continue;
    const File file = File::open_read(path);
    visit(file);
    const SceneFormat& format = detect_format(file);
    if (format.visit_beside != nullptr)
      format.visit_beside(content_of(file),
                          {budget_, config_.colours, config_.allow_outside,
                           config_.cut_outs ? &config_.names : nullptr},
                          visit);
  }
}

}  // namespace svdag
