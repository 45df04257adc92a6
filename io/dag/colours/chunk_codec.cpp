#include "io/dag/colours/chunk_codec.h"

#include <algorithm>
#include <cmath>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint32_t kJudged = 64;  // colours that are judged at once
constexpr int kRefits = 3, kStepRounds = 3;

int32_t channel_of(uint32_t colour, size_t c) {
  return int32_t(colour >> 8 * c & 0xffU);
}

uint32_t packed(const std::array<uint8_t, 3>& channels, uint32_t bits) {
  return channels[0] | uint32_t(channels[1]) << bits | uint32_t(channels[2]) << 2 * bits;
}

// Appends bits to words, the lowest first.
class PackedBits {
 public:
  explicit PackedBits(std::vector<uint32_t>* words) : words_(words) {}

  void put(uint64_t value, uint32_t bits) {  // at most 32
    pending_ |= value << used_;
    used_ += bits;
    position_ += bits;
    if (used_ < 32) return;
    words_->push_back(uint32_t(pending_));
    pending_ >>= 32;
    used_ -= 32;
  }
  void finish() {
    if (used_ > 0) words_->push_back(uint32_t(pending_));
  }
  uint32_t position() const { return position_; }

 private:
  std::vector<uint32_t>* words_;
  uint64_t pending_ = 0;
  uint32_t used_ = 0, position_ = 0;
};

}  // namespace

// The direction has whole numbers, so that the projections of colours are exact.
struct ChunkEncoder::Line {
  std::array<double, 3> mean{};
  std::array<int32_t, 3> direction{};
  double mean_at = 0, squared_length = 1;
  int32_t low = 0, high = 0;  // the projections of the colours

  // The end at the projection `at`, in 6 bits a channel.
  std::array<uint8_t, 3> end_at(double at) const {
    std::array<uint8_t, 3> end{};
    for (size_t c = 0; c < 3; ++c) {
      const double value = mean[c] + (at - mean_at) / squared_length * direction[c];
      end[c] = uint8_t(std::min(std::max(value, 0.0), 255.0) * 63 / 255 + 0.5);
    }
    return end;
  }
};

ChunkEncoder::Line ChunkEncoder::line_through(uint32_t begin, uint32_t end) const {
  const double n = end - begin;
  std::array<double, 3> sum{};
  std::array<double, 6> product{};
  for (size_t c = 0; c < 3; ++c) sum[c] = double(moments_[end].sum[c] - moments_[begin].sum[c]);
  for (size_t c = 0; c < 6; ++c)
    product[c] = double(moments_[end].product[c] - moments_[begin].product[c]);
  const double a = n * product[0] - sum[0] * sum[0], b = n * product[1] - sum[0] * sum[1];
  const double c = n * product[2] - sum[0] * sum[2], d = n * product[3] - sum[1] * sum[1];
  const double e = n * product[4] - sum[1] * sum[2], f = n * product[5] - sum[2] * sum[2];
  // The main direction of the covariance by powers, from its largest column.
  double x = 1, y = 1, z = 1;
  if (a > 0 || d > 0 || f > 0) {
    if (a >= d && a >= f) {
      x = a, y = b, z = c;
    } else if (d >= f) {
      x = b, y = d, z = e;
    } else {
      x = c, y = e, z = f;
    }
    for (int i = 0;; ++i) {
      const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
      x /= largest, y /= largest, z /= largest;
      if (i == 4) break;
      const double nx = a * x + b * y + c * z, ny = b * x + d * y + e * z;
      z = c * x + e * y + f * z;
      x = nx, y = ny;
    }
  }
  Line line;
  line.direction = {int32_t(std::floor(1024 * x + 0.5)), int32_t(std::floor(1024 * y + 0.5)),
                    int32_t(std::floor(1024 * z + 0.5))};
  line.squared_length = 0;
  for (size_t i = 0; i < 3; ++i) {
    line.mean[i] = sum[i] / n;
    line.mean_at += line.mean[i] * line.direction[i];
    line.squared_length += double(line.direction[i]) * line.direction[i];
  }
  const int32_t *const r = channel_[0].data(), *const g = channel_[1].data(),
                       *const bl = channel_[2].data();
  const int32_t dr = line.direction[0], dg = line.direction[1], db = line.direction[2];
  int32_t low = INT32_MAX, high = INT32_MIN;
  for (uint32_t i = begin; i < end; ++i) {
    const int32_t at = r[i] * dr + g[i] * dg + bl[i] * db;
    low = std::min(low, at);
    high = std::max(high, at);
  }
  line.low = low;
  line.high = high;
  return line;
}

template <class Visit>
bool ChunkEncoder::for_candidates(uint32_t kind, uint32_t begin, uint32_t end, bool all,
                                  const Visit& visit) const {
  if (is_line(kind)) {
    const Line line = line_through(begin, end);
    const double range = double(line.high) - line.low;
    // A colour next to an end may be half a step beyond it.
    constexpr double kInsets[] = {0.12, 0.07, 0.04, 0.02};
    const double inset = kInsets[kind - kLineRun];
    const double fractions[] = {inset, 0, inset / 2, 0.02};
    for (size_t i = 0; i < (all ? 4U : 2U); ++i) {
      const double part = fractions[i] * range;
      if (visit(Ends{line.end_at(line.low + part), line.end_at(line.high - part)})) return true;
    }
    return false;
  }
  const int64_t n = end - begin;
  Ends mean, middle;
  for (size_t c = 0; c < 3; ++c)
    mean.a[c] = uint8_t((2 * (moments_[end].sum[c] - moments_[begin].sum[c]) + n) / (2 * n));
  if (visit(mean)) return true;
  for (size_t c = 0; c < 3; ++c) {
    const auto [low, high] =
        std::minmax_element(channel_[c].begin() + begin, channel_[c].begin() + end);
    middle.a[c] = uint8_t((*low + *high + 1) / 2);
  }
  return visit(middle);
}

namespace {

// What the judge needs of a line: the weight of a colour by its projection, and the palette.
struct LinePalette {
  LinePalette(uint32_t kind, const std::array<uint8_t, 3>& from, const std::array<uint8_t, 3>& to)
      : last(int32_t(1U << (kind - 1)) - 1) {
    int32_t squared = 0;
    for (size_t c = 0; c < 3; ++c) {
      a[c] = int32_t(end_channel(from[c]));
      d[c] = int32_t(end_channel(to[c])) - a[c];
      squared += d[c] * d[c];
    }
    scale = squared > 0 ? float(last) / float(squared) : 0.0F;
  }
  // Fixed-order float: the same weight wherever it is computed.
  int32_t weight(int32_t r, int32_t g, int32_t b) const {
    const int32_t at = (r - a[0]) * d[0] + (g - a[1]) * d[1] + (b - a[2]) * d[2];
    const float w = float(at) * scale + 0.5F;
    return int32_t(std::min(std::max(w, 0.0F), float(last)));
  }

  std::array<int32_t, 3> a, d;
  int32_t last;
  float scale;
};

}  // namespace

int64_t ChunkEncoder::squared_error(uint32_t kind, uint32_t begin, uint32_t end,
                                    const Ends& ends) const {
  const int32_t *const r = channel_[0].data(), *const g = channel_[1].data(),
                       *const b = channel_[2].data();
  int64_t sum = 0;
  const auto judge = [&](const auto& error_of) {
    for (uint32_t to = end; to > begin;) {  // what does not fit is usually at the end
      const uint32_t from = to - std::min(kJudged, to - begin);
      int32_t worst = 0, part = 0;
      for (uint32_t i = from; i < to; ++i) {
        const int32_t error = error_of(i);
        worst = std::max(worst, error);
        part += error;
      }
      if (worst > max_squared_) return false;
      sum += part;
      to = from;
    }
    return true;
  };
  if (!is_line(kind)) {
    const int32_t cr = ends.a[0], cg = ends.a[1], cb = ends.a[2];
    const bool fits = judge([&](uint32_t i) {
      const int32_t x = r[i] - cr, y = g[i] - cg, z = b[i] - cb;
      return x * x + y * y + z * z;
    });
    return fits ? sum : -1;
  }
  const LinePalette line(kind, ends.a, ends.b);
  const int32_t last = line.last, factor = 65535 / last + 1;
  const int32_t base[3] = {line.a[0] * last + last / 2, line.a[1] * last + last / 2,
                           line.a[2] * last + last / 2};
  const bool fits = judge([&](uint32_t i) {
    const int32_t weight = line.weight(r[i], g[i], b[i]);
    // line_channel()
    const int32_t x = r[i] - ((base[0] + weight * line.d[0]) * factor >> 16);
    const int32_t y = g[i] - ((base[1] + weight * line.d[1]) * factor >> 16);
    const int32_t z = b[i] - ((base[2] + weight * line.d[2]) * factor >> 16);
    return x * x + y * y + z * z;
  });
  return fits ? sum : -1;
}

bool ChunkEncoder::search(uint32_t kind, uint32_t begin, uint32_t end, Ends* ends) const {
  return for_candidates(kind, begin, end, false, [&](const Ends& candidate) {
    if (squared_error(kind, begin, end, candidate) < 0) return false;
    *ends = candidate;
    return true;
  });
}

// The two pointers: the longest run that ends before `end`, from the one that ends a colour
// earlier.
void ChunkEncoder::find_window(uint32_t kind, uint32_t end) {
  uint32_t first = std::max(first_[kind][end - 1], barrier_[end]);
  // A line is of no use where a cheaper kind fits.
  uint32_t limit = end;
  if (kind != kLongRun) {
    if (end > kMaxRun) first = std::max(first, end - kMaxRun);
    limit = first_[kind == kLineRun ? uint32_t(kConstantRun) : kind - 1][end];
  }
  Ends ends = ends_[kind][end - 1];
  bool found =
      first < limit && has_ends_[kind][end - 1] && squared_error(kind, end - 1, end, ends) >= 0;
  if (!found && first < limit) found = search(kind, first, end, &ends);
  if (!found && first < limit) {
    uint32_t bad = first, good = limit;
    Ends better;
    for (uint32_t step = 1; bad + step < limit; step *= 2) {
      if (search(kind, bad + step, end, &better)) {
        good = bad + step, ends = better, found = true;
        break;
      }
      bad += step;
    }
    while (good - bad > 1) {
      const uint32_t middle = (good + bad) / 2;
      if (search(kind, middle, end, &better)) {
        good = middle, ends = better, found = true;
      } else {
        bad = middle;
      }
    }
    first = good;
  }
  first_[kind][end] = first;
  ends_[kind][end] = ends;
  has_ends_[kind][end] = found;
}

void ChunkEncoder::find_windows() {
  for (uint32_t kind = 0; kind < kRunKinds; ++kind) {
    first_[kind].assign(count_ + 1, 0);
    ends_[kind].assign(count_ + 1, {});
    has_ends_[kind].assign(count_ + 1, 0);
  }
  for (uint32_t end = 1; end <= count_; ++end) {
    const uint32_t short_first = end > kMaxRun ? end - kMaxRun : 0;
    const bool none = colours_[end - 1] == kNoColour;
    if (none) {
      for (uint32_t kind = 0; kind < kNoRun; ++kind) first_[kind][end] = end;
      first_[kNoRun][end] = std::max(short_first, std::min(first_[kNoRun][end - 1], end - 1));
      continue;
    }
    find_window(kLongRun, end);
    first_[kConstantRun][end] = std::max(short_first, first_[kLongRun][end]);
    for (uint32_t kind = kLineRun; kind < kRawRun; ++kind) find_window(kind, end);
    first_[kRawRun][end] = std::max(short_first, barrier_[end]);
    first_[kNoRun][end] = end;
  }
}

void ChunkEncoder::find_runs() {
  cost_.assign(count_ + 1, 0);
  run_start_.assign(count_ + 1, 0);
  run_kind_.assign(count_ + 1, 0);
  // Per kind the starts that may still be the cheapest, ascending in cost without colours.
  struct Starts {
    std::vector<uint32_t> at;
    size_t begin = 0;
  };
  std::array<Starts, kRunKinds> starts;
  for (uint32_t end = 1; end <= count_; ++end) {
    uint32_t best = UINT32_MAX;
    const auto consider = [&](uint32_t kind, uint32_t start) {
      const uint32_t cost =
          cost_[start] + kRunCost + bits_per_run(kind) + bits_per_colour(kind) * (end - start);
      if (cost >= best) return;
      best = cost;
      run_start_[end] = start;
      run_kind_[end] = uint8_t(kind);
    };
    for (uint32_t kind = 0; kind < kRunKinds; ++kind) {
      if (kind == kLongRun) continue;
      auto& [at, begin] = starts[kind];
      const auto key = [&](uint32_t start) {
        return int64_t(cost_[start]) - int64_t(bits_per_colour(kind)) * start;
      };
      while (at.size() > begin && key(at.back()) > key(end - 1)) at.pop_back();
      at.push_back(end - 1);
      while (begin < at.size() && at[begin] < first_[kind][end]) ++begin;
      if (begin < at.size()) consider(kind, at[begin]);
    }
    // 64 lengths at most, each a multiple of 256.
    for (uint32_t length = kMaxRun; length <= end - first_[kLongRun][end]; length += kMaxRun)
      consider(kLongRun, end - length);
    cost_[end] = best;
  }
}

// The ends that fit the colours best with the weights that `ends` give them: least squares.
ChunkEncoder::Ends ChunkEncoder::refitted(uint32_t kind, uint32_t begin, uint32_t end,
                                          const Ends& ends) const {
  const LinePalette line(kind, ends.a, ends.b);
  int64_t aa = 0, ab = 0, bb = 0;
  std::array<int64_t, 3> a_sum{}, b_sum{};
  for (uint32_t i = begin; i < end; ++i) {
    const int64_t b = line.weight(channel_[0][i], channel_[1][i], channel_[2][i]);
    const int64_t a = line.last - b;
    aa += a * a, ab += a * b, bb += b * b;
    for (size_t c = 0; c < 3; ++c) a_sum[c] += a * channel_[c][i], b_sum[c] += b * channel_[c][i];
  }
  const int64_t determinant = aa * bb - ab * ab;
  if (determinant == 0) return ends;  // all have one weight
  Ends result;
  const auto code = [&](int64_t numerator) {
    const double value = double(line.last * numerator) / double(determinant);
    return uint8_t(std::min(std::max(value, 0.0), 255.0) * 63 / 255 + 0.5);
  };
  for (size_t c = 0; c < 3; ++c) {
    result.a[c] = code(a_sum[c] * bb - b_sum[c] * ab);
    result.b[c] = code(b_sum[c] * aa - a_sum[c] * ab);
  }
  return result;
}

// The run is fixed: of the ends within the error, these have a small sum of squares. A local
// search: the candidates, least squares, then steps of one channel.
ChunkEncoder::Ends ChunkEncoder::best_ends(uint32_t kind, uint32_t begin, uint32_t end) const {
  const uint32_t searched = kind == kConstantRun ? uint32_t(kLongRun) : kind;
  Ends best = ends_[searched][end];
  int64_t least = squared_error(kind, begin, end, best);
  SVDAG_ASSERT(has_ends_[searched][end] && least >= 0);
  const auto consider = [&](const Ends& candidate) {
    const int64_t error = squared_error(kind, begin, end, candidate);
    if (error < 0 || error >= least) return false;
    least = error;
    best = candidate;
    return true;
  };
  for_candidates(kind, begin, end, true, [&](const Ends& candidate) {
    consider(candidate);
    return false;
  });
  for (int i = 0; is_line(kind) && i < kRefits && consider(refitted(kind, begin, end, best)); ++i) {
  }
  const int largest = is_line(kind) ? 63 : 255;
  for (int round = 0, improved = 1; improved != 0 && round < kStepRounds; ++round) {
    improved = 0;
    for (auto* const channels : {&best.a, &best.b}) {
      if (channels == &best.b && !is_line(kind)) continue;
      for (uint8_t& channel : *channels) {
        const uint8_t before = channel;
        for (const int step : {-1, 1}) {
          if (before + step < 0 || before + step > largest) continue;
          channel = uint8_t(before + step);
          const Ends candidate = best;
          channel = before;
          if (!consider(candidate)) continue;
          improved = 1;
          break;
        }
      }
    }
  }
  return best;
}

void ChunkEncoder::emit(std::vector<uint32_t>* words) const {
  struct Run {
    uint32_t begin, end, kind;
  };
  std::vector<Run> runs;
  for (uint32_t end = count_; end > 0; end = runs.back().begin)
    runs.push_back({run_start_[end], end, run_kind_[end]});
  std::reverse(runs.begin(), runs.end());
  const uint32_t groups = chunk_groups(uint32_t(runs.size()));
  words->push_back(uint32_t(runs.size()));
  const size_t first_group = words->size();
  words->resize(first_group + groups);
  PackedBits headers(words);
  for (const auto& [begin, end, kind] : runs) {
    const uint32_t length = (end - begin) / (kind == kLongRun ? kMaxRun : 1);
    headers.put((length - 1) | kind << 8, kRunHeaderBits);
  }
  headers.finish();
  PackedBits payload(words);
  for (size_t i = 0; i < runs.size(); ++i) {
    const auto& [begin, end, kind] = runs[i];
    if (i % kGroupRuns == 0) {
      payload.put(0, payload.position() & 1);
      (*words)[first_group + i / kGroupRuns] = begin | payload.position() / 2 << kGroupRankBits;
    }
    if (kind == kNoRun) continue;
    if (kind == kRawRun) {
      for (uint32_t k = begin; k < end; ++k) payload.put(colours_[k], kColourBits);
      continue;
    }
    const Ends ends = best_ends(kind, begin, end);
    if (!is_line(kind)) {
      payload.put(packed(ends.a, 8), kColourBits);
      continue;
    }
    payload.put(packed(ends.a, 6), kEndBits);
    payload.put(packed(ends.b, 6), kEndBits);
    const LinePalette line(kind, ends.a, ends.b);
    for (uint32_t k = begin; k < end; ++k)
      payload.put(uint32_t(line.weight(channel_[0][k], channel_[1][k], channel_[2][k])), kind - 1);
  }
  payload.finish();
}

void ChunkEncoder::encode(std::span<const uint32_t> colours, std::vector<uint32_t>* words) {
  SVDAG_ASSERT(!colours.empty() && colours.size() <= kChunkColours);
  colours_ = colours;
  count_ = uint32_t(colours.size());
  moments_.assign(count_ + 1, {});
  barrier_.assign(count_ + 1, 0);
  for (auto& channel : channel_) channel.resize(count_);
  for (uint32_t i = 0; i < count_; ++i) {
    std::array<int32_t, 3> v{};
    for (size_t c = 0; c < 3; ++c) v[c] = channel_[c][i] = channel_of(colours[i], c);
    Moments& next = moments_[i + 1];
    next = moments_[i];
    for (size_t c = 0, k = 0; c < 3; ++c) {
      next.sum[c] += v[c];
      for (size_t d = c; d < 3; ++d) next.product[k++] += int64_t(v[c]) * v[d];
    }
    barrier_[i + 1] = colours[i] == kNoColour ? i + 1 : barrier_[i];
  }
  find_windows();
  find_runs();
  emit(words);
}

void decode_chunk(const uint32_t* words, std::span<uint32_t> colours) {
  const uint32_t runs = words[0], groups = chunk_groups(runs);
  const uint64_t headers = 32 * uint64_t(1 + groups);
  const uint64_t payload = headers + 32 * uint64_t(chunk_header_words(runs));
  uint64_t bits = 0;
  size_t at = 0;
  for (uint32_t run = 0; run < runs; ++run) {
    if (run % kGroupRuns == 0) bits += bits & 1;
    const uint32_t header =
        bits_at(words, headers + uint64_t(run) * kRunHeaderBits, kRunHeaderBits);
    const uint32_t kind = header >> 8, length = run_length(header);
    for (uint32_t i = 0; i < length; ++i)
      colours[at++] = run_colour(words, kind, payload + bits, i);
    bits += bits_per_run(kind) + uint64_t(bits_per_colour(kind)) * length;
  }
}

}  // namespace svdag
