#include "verify/colours/colour_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "io/dag/colours/dag_colours.h"
#include "io/lattice.h"
#include "verify/colours/cube_estimate.h"
#include "verify/judge/judge_cells.h"

namespace svdag {
namespace {

constexpr double kRounding = 1;  // steps

// Counts of the cubes of the colour level.
class CoveredCubes {
 public:
  CoveredCubes(const DagFile& file, MemoryBudget* budget)
      : dag_(file.view()),
        level_(file.header().colour_level),
        counts_(dag_, level_, false, budget) {}

  uint64_t count() const { return counts_.total(); }
  // The Morton code of the cube with this number, in depth-first order.
  uint64_t code(uint64_t number) const {
    CoveredCube cube;
    while (cube.level < level_) {
      std::optional<CoveredCube> inside;
      for_covered_children(dag_, cube, [&](const CoveredCube& child) {
        if (inside) return;
        const uint64_t count = counts_.of(child);
        if (number < count)
          inside = child;
        else
          number -= count;
      });
      cube = *inside;
    }
    return cube.morton;
  }

 private:
  const DagView& dag_;
  uint32_t level_;
  ColourCountTables counts_;
};

// The codes of the drawn cubes, ascending.
std::vector<uint64_t> draw_cubes(const CoveredCubes& cubes, const ColourDraw& draw) {
  std::set<uint64_t> numbers;
  if (draw.count < cubes.count()) {
    Random random(draw.seed);
    while (numbers.size() < draw.count) numbers.insert(random.below(cubes.count()));
  } else {
    for (uint64_t i = 0; i < cubes.count(); ++i) numbers.insert(i);
  }
  std::vector<uint64_t> codes;
  for (const uint64_t number : numbers) codes.push_back(cubes.code(number));
  return codes;
}

// The textures of a scene, each decoded when it is first met.
class JudgedTextures {
 public:
  JudgedTextures(bool sandbox, MemoryBudget* budget) : sandbox_(sandbox), budget_(*budget) {}

  const JudgedTexture* of(const std::shared_ptr<const LinearImage>& image) {
    if (!image) return nullptr;
    const auto [entry, is_new] = textures_.try_emplace(image);
    if (is_new) {
      entry->second.memory = budget_.reserve(
          4 * uint64_t(image->width()) * uint64_t(image->height()), "textures of the judge");
      entry->second.texture.emplace(*image, sandbox_);
    }
    return &*entry->second.texture;
  }

 private:
  struct Held {
    MemoryBudget::Reservation memory;
    std::optional<JudgedTexture> texture;
  };
  bool sandbox_;
  MemoryBudget& budget_;
  std::map<std::shared_ptr<const LinearImage>, Held> textures_;
};

// Estimates drawn cubes from a stream of triangles.
class ColourSample {
 public:
  ColourSample(const DagFile& file, const std::vector<uint64_t>& codes, uint64_t seed)
      : grid_(file.grid()),
        lattice_(grid_),
        level_(int(file.header().colour_level)),
        codes_(codes),
        estimates_(codes.size()),
        random_(seed) {}

  void read(const TriangleBatch& batch, JudgedTextures* textures) {
    JudgedTriangle t;
    if (batch.colour) {
      t.colour = {light_of_srgb(batch.colour->r), light_of_srgb(batch.colour->g),
                  light_of_srgb(batch.colour->b)};
    }
    for (size_t k = 0; k < batch.triangles.size(); ++k) {
      for (size_t i = 0; i < 3; ++i) t.corners[i] = lattice_.snap(batch.triangles[k].v[i]);
      if (batch.paint != nullptr) {
        t.paint = batch.paint;
        t.corner_colours = batch.corner_colours[k];
        t.texture = nullptr;
        // A triangle that is nowhere in its texture has none.
        if (batch.paint->image && std::ranges::all_of(batch.texture[k], is_placeable)) {
          t.points = batch.texture[k];
          t.texture = textures->of(batch.paint->image);
        }
      }
      descend(t, box_of({t.corners}), 0, 0, 0, codes_.size());
    }
  }

  const std::vector<CubeEstimate>& estimates() const { return estimates_; }

 private:
  // The drawn cubes begin .. end - 1 are those in the cube of `level` with this code.
  void descend(const JudgedTriangle& t, const LatticeBox& box, int level, uint64_t code,
               size_t begin, size_t end) {
    if (begin == end) return;
    const int64_t side = int64_t(1) << (grid_.fraction() + grid_.levels - level);
    const LatticePoint corner = cell_of_code(code) * side;
    if (!box.meets({corner, corner + side})) return;
    if (level == level_) return estimates_[begin].add(t, corner, side, random_);
    for (uint64_t c = 0; c < 8; ++c) {
      const uint64_t after = ((code << 3 | c) + 1) << 3 * (level_ - level - 1);
      const size_t next =
          size_t(std::lower_bound(codes_.begin() + long(begin), codes_.begin() + long(end), after) -
                 codes_.begin());
      descend(t, box, level + 1, code << 3 | c, begin, next);
      begin = next;
    }
  }

  const Grid grid_;
  const Lattice lattice_;
  const int level_;
  const std::vector<uint64_t>& codes_;
  std::vector<CubeEstimate> estimates_;
  Random random_;
};

double channel_of(uint32_t colour, size_t channel) {
  return double(colour >> 8 * channel & 255U);
}

// Compares stored colours with what they should be.
class ColourJudge {
 public:
  ColourJudge(const DagFile& file, MemoryBudget* budget)
      : colours_(file, budget),
        level_(file.header().colour_level),
        error_(double(file.header().colour_error) / kColourErrorUnit) {}

  void judge(uint64_t code, const CubeEstimate& estimate) {
    const LatticePoint cube = cell_of_code(code);
    const uint32_t stored =
        svdag_colour(colours_.view(), level_, uint32_t(cube.x), uint32_t(cube.y), uint32_t(cube.z));
    if (!estimate.is_touched()) {
      ++(stored == kNoColour ? out_.without_colour : out_.without_triangle);
      return;
    }
    if (!estimate.has_mean()) {
      ++out_.without_mean;
      return;
    }
    ++out_.judged;
    out_.at_seams += estimate.is_at_seam();
    WrongColour w{cube, stored, {}, {}, 0};
    for (size_t c = 0; c < 3; ++c) {
      const double mean = estimate.mean(c), tolerance = estimate.tolerance(c);
      check(c, mean, std::max(0.0, mean - tolerance), std::min(1.0, mean + tolerance),
            estimate.decoder_error(), &w);
      if (stored != kNoColour) {
        const double difference = std::abs(channel_of(stored, c) - std::round(w.expected[c]));
        differences_.push_back(difference);
        if (estimate.is_at_seam()) out_.mean_at_seams += difference / 3;
      }
      allowed_ += w.allowed[c];
    }
    if (w.excess <= 0) return;
    ++out_.wrong;
    out_.worst.push_back(w);
  }

  ColourComparison result() {
    std::ranges::stable_sort(out_.worst, std::greater(), &WrongColour::excess);
    if (out_.worst.size() > out_.kShown) out_.worst.resize(out_.kShown);
    if (out_.judged > 0) out_.mean_allowed = allowed_ / double(3 * out_.judged);
    if (out_.at_seams > 0) out_.mean_at_seams /= double(out_.at_seams);
    if (differences_.empty()) return out_;
    std::ranges::sort(differences_);
    for (const double d : differences_) out_.mean += d / double(differences_.size());
    out_.permille_999 = differences_[(differences_.size() - 1) * 999 / 1000];
    out_.largest = differences_.back();
    return out_;
  }

  ColourComparison* out() { return &out_; }

 private:
  // Of linear light: a right colour before it is encoded is in low .. high. `steps`: allowed beside
  // codec and rounding.
  void check(size_t channel, double mean, double low, double high, double steps,
             WrongColour* w) const {
    const double expected = srgb_of_light(std::min(mean, 1.0));
    const double below = expected - srgb_of_light(low), above = srgb_of_light(high) - expected;
    const double fixed = error_ + kRounding + steps;
    w->expected[channel] = expected;
    w->allowed[channel] = fixed + std::max(below, above);
    const double difference = channel_of(w->stored, channel) - expected;
    const double excess = w->stored == kNoColour ? 255
                          : difference > 0       ? difference - above - fixed
                                                 : -difference - below - fixed;
    w->excess = std::max(w->excess, excess);
  }

  DagColours colours_;
  uint32_t level_;
  double error_;  // of the codec, in steps
  std::vector<double> differences_;
  double allowed_ = 0;
  ColourComparison out_;
};

}  // namespace

ColourComparison compare_colours(const Scene& scene, const DagFile& file, const ColourDraw& draw,
                                 MemoryBudget* budget, Progress* progress) {
  const CoveredCubes cubes(file, budget);
  const auto held = budget->reserve(
      std::min(draw.count, cubes.count()) * (sizeof(CubeEstimate) + sizeof(WrongColour) + 128),
      "drawn cubes");
  const std::vector<uint64_t> codes = draw_cubes(cubes, draw);
  ColourSample sample(file, codes, draw.seed);
  {
    JudgedTextures textures(scene.config().sandbox, budget);
    progress->phase("reading the scene", 0, "triangles");
    scene.stream([&](const TriangleBatch& batch) {
      sample.read(batch, &textures);
      progress->advance(batch.triangles.size(), batch.triangles.size());
    });
  }
  ColourJudge judge(file, budget);
  judge.out()->covered = cubes.count();
  judge.out()->drawn = codes.size();
  for (size_t i = 0; i < codes.size(); ++i) judge.judge(codes[i], sample.estimates()[i]);
  return judge.result();
}

}  // namespace svdag
