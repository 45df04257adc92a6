#include "verify/trace/cpu.h"

#include <algorithm>

#include "verify/trace/kernel/beam.h"
#include "verify/trace/kernel/rays.h"

namespace svdag {
namespace {

// Number of rays to the light or the sky for each camera ray that hits.
uint32_t secondary_per_ray(const Shading& shading) {
  if (shading.mode == ShadeMode::kShadow) return 1;
  const bool many = shading.mode == ShadeMode::kSoft || shading.mode == ShadeMode::kAo;
  return many ? shading.secondary.samples : 0;
}

// Renders tiles. The memory of a tile's rays is reused for the next one.
class PixelTile {
 public:
  PixelTile(const DagView& dag, const Tree64View& tree, const Camera& camera,
            const Shading& shading, const RenderConfig& config)
      : dag_(dag), tree_(tree), camera_(camera), shading_(shading), config_(config) {}

  void render(int left, int top, Image* image) {
    left_ = left, top_ = top;
    width_ = std::min(int(kTile), config_.width - left);
    height_ = std::min(int(kTile), config_.height - top);
    make_camera_rays();
    trace_camera_rays();
    trace_secondary_rays();
    paint(image);
  }

 private:
  int per_pixel() const { return config_.supersample * config_.supersample; }

  // Pixel by pixel.
  void make_camera_rays() {
    rays_.clear();
    const int n = config_.supersample;
    for (int p = 0; p < width_ * height_; ++p) {
      for (int i = 0; i < n * n; ++i) {
        const double x = left_ + p % width_ + (i % n + 0.5) / n;
        const double y = top_ + p / width_ + (i / n + 0.5) / n;
        rays_.push_back(camera_.ray(x / config_.width, y / config_.height));
      }
    }
  }

  void trace_camera_rays() {
    hits_.resize(rays_.size());
    section_.assign(rays_.size(), false);
    if (config_.clip) return trace_clipped_rays();
    const Span span = config_.beams ? beam_span(rays_, {}, shading_.primary, false) : Span{};
    trace_closest(dag_, tree_, rays_.data(), rays_.size(), span, shading_.primary, hits_.data());
    make_surfels();
  }

  // One by one: the rays of a beam have different spans in the box.
  void trace_clipped_rays() {
    std::vector<int> entry(rays_.size(), -1);
    for (size_t i = 0; i < rays_.size(); ++i) {
      hits_[i] = {};
      const auto part = clip(*config_.clip, rays_[i], dag_.resolution(), {});
      if (!part) continue;
      hits_[i] = trace_closest(dag_, rays_[i], part->span, shading_.primary);
      section_[i] = shading_.linear() && is_section(*part, hits_[i]);
      entry[i] = part->entry;
    }
    make_surfels();
    for (size_t i = 0; i < rays_.size(); ++i) {
      if (!section_[i] || !surfels_[i].found) continue;
      const int a = entry[i];
      surfels_[i].normal = {};
      surfels_[i].normal[a] = rays_[i].direction[a] < 0 ? 1 : -1;
    }
  }

  void make_surfels() {
    surfels_.clear();
    const bool needs_surfels =
        shading_.mode != ShadeMode::kDepth && shading_.mode != ShadeMode::kSteps;
    for (size_t i = 0; i < rays_.size(); ++i) {
      surfels_.push_back(needs_surfels ? make_surfel(dag_, rays_[i], hits_[i]) : Surfel{});
      Surfel& surfel = surfels_.back();
      if (surfel.found) surfel.normal = shown_normal(shading_, rays_[i], hits_[i], surfel.normal);
    }
  }

  Span beam_span(const std::vector<Ray>& rays, const Span& span, const Cut& cut, bool both) const {
    Beam beam;
    for (const Ray& ray : rays) beam.add(ray);
    return beam.reach(dag_, span, cut, both);
  }

  // Computes the part of the light, or of the sky, that is visible from each surfel.
  void trace_secondary_rays() {
    visibility_.assign(rays_.size(), 1);
    const bool ao = shading_.mode == ShadeMode::kAo;
    const uint32_t n = secondary_per_ray(shading_);
    if (n == 0) return;
    secondary_.clear();
    for (size_t i = 0; i < rays_.size(); ++i) {
      for (uint32_t k = 0; surfels_[i].found && k < n; ++k)
        secondary_.push_back(secondary_ray(i, k, n));
    }
    Span span{0, ao ? shading_.secondary.reach : 1};
    if (!ao && !config_.clip && config_.beams && !secondary_.empty())
      span = beam_span(secondary_, span, shading_.secondary.cut, true);
    blocked_.resize(secondary_.size());
    if (config_.clip)
      trace_clipped_secondary(span);
    else
      trace_any(dag_, tree_, secondary_.data(), secondary_.size(), span, shading_.secondary.cut,
                blocked_.data());
    size_t at = 0;
    for (size_t i = 0; i < rays_.size(); ++i) {
      if (!surfels_[i].found) continue;
      const auto first = blocked_.begin() + std::ptrdiff_t(at);
      const auto blocked = std::count(first, first + n, uint8_t(1));
      visibility_[i] = 1 - double(blocked) / n;
      at += n;
    }
  }

  void trace_clipped_secondary(const Span& span) {
    for (size_t i = 0; i < secondary_.size(); ++i) {
      const auto part = clip(*config_.clip, secondary_[i], dag_.resolution(), span);
      blocked_[i] = part && trace_any(dag_, secondary_[i], part->span, shading_.secondary.cut);
    }
  }

  Ray secondary_ray(size_t i, uint32_t k, uint32_t n) const {
    const int pixel = int(i) / per_pixel();
    const uint64_t x = uint64_t(left_ + pixel % width_), y = uint64_t(top_ + pixel / width_);
    const uint64_t number = (y << 32 | x) << 8 | (i % size_t(per_pixel()));
    if (shading_.mode == ShadeMode::kShadow) return shadow_ray(surfels_[i], shading_.light);
    return shading_.mode == ShadeMode::kSoft ? soft_ray(surfels_[i], shading_.light, number, k, n)
                                             : occlusion_ray(surfels_[i], number, k, n);
  }

  void paint(Image* image) const {
    const int n = per_pixel();
    for (int p = 0; p < width_ * height_; ++p) {
      Vec3 sum{};
      for (size_t i = size_t(p * n); i < size_t(p * n + n); ++i)
        sum = sum + (section_[i] ? section_colour(shading_, surfels_[i])
                                 : shade(shading_, rays_[i], hits_[i], surfels_[i], visibility_[i],
                                         albedo(hits_[i]))) *
                        grid_line(shading_, rays_[i], hits_[i]);
      const Vec3 colour = sum * (1.0 / n);
      const int x = left_ + p % width_, y = top_ + p / width_;
      shading_.linear() ? image->set(x, y, colour) : image->set_raw(x, y, colour);
    }
  }

  Vec3 stored_albedo(const Hit& hit) const {
    const uint32_t shift = dag_.levels - hit.level;
    const uint32_t colour = svdag_colour(*config_.colours, hit.level, hit.voxel[0] >> shift,
                                         hit.voxel[1] >> shift, hit.voxel[2] >> shift);
    if (colour == kNoColour) return kClay;
    return albedo_of({uint8_t(colour), uint8_t(colour >> 8), uint8_t(colour >> 16)});
  }

  Vec3 albedo(const Hit& hit) const {
    if (!hit.found || !shading_.shows_layers()) return kClay;
    if (config_.colours != nullptr) return stored_albedo(hit);
    if (config_.albedos.empty()) return kClay;
    const uint32_t layer =
        layer_of_cube(dag_, config_.layers, hit.level, hit.voxel[0], hit.voxel[1], hit.voxel[2]);
    return layer == kNoLayer ? kClay : config_.albedos[layer];
  }

  const DagView& dag_;
  const Tree64View& tree_;
  const Camera& camera_;
  const Shading& shading_;
  const RenderConfig& config_;
  int left_ = 0, top_ = 0, width_ = 0, height_ = 0;
  std::vector<Ray> rays_, secondary_;
  std::vector<Hit> hits_;
  std::vector<Surfel> surfels_;
  std::vector<uint8_t> blocked_;
  std::vector<bool> section_;  // of each ray: hits where the clip box cuts through matter
  std::vector<double> visibility_;
};

}  // namespace

ShownColours::ShownColours(const DagFile& file) : budget_(memory_or_default(0)) {
  if (file.has_colours()) colours_.emplace(file, &budget_);
  if (file.has_colours() || file.layers().empty()) return;
  index_.emplace(file.layer_index());
  for (const Layer& layer : file.layers().layers) albedos_.push_back(albedo_of(layer.colour));
}

void ShownColours::show_in(RenderConfig* picture) const {
  if (colours_) picture->colours = &colours_->view();
  if (!index_) return;
  picture->layers = index_->view();
  picture->albedos = albedos_;
}

uint64_t uncut_rays(const DagView& dag, const Shading& shading, const RenderConfig& config) {
  const uint64_t per_pixel = uint64_t(config.supersample) * uint64_t(config.supersample);
  const uint64_t primary = shading.primary.cuts(dag.levels) ? 0 : 1;
  const uint64_t secondary =
      shading.secondary.cut.cuts(dag.levels) ? 0 : secondary_per_ray(shading);
  return uint64_t(config.width) * uint64_t(config.height) * per_pixel * (primary + secondary);
}

Image render(const DagView& dag, const Tree64View& tree, const Camera& camera,
             const Shading& shading, const RenderConfig& config, Executor& executor,
             Progress& progress) {
  Image image(config.width, config.height);
  const size_t rows = (size_t(config.height) + kTile - 1) / kTile;
  progress.phase("rendering", rows);
  executor.for_each(rows, [&](size_t, size_t row) {
    PixelTile tile(dag, tree, camera, shading, config);
    for (int x = 0; x < config.width; x += int(kTile)) tile.render(x, int(row * kTile), &image);
    progress.advance();
  });
  progress.finish();
  return image;
}

}  // namespace svdag
