#include "io/scene/gltf/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "io/scene/gltf/document/gltf_elements.h"
#include "io/scene/gltf/document/tile.h"
#include "io/trigonometry.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

using Values = std::vector<double>;

constexpr double kClose = 0.9995;  // cosine of half of the angle between two rotations

constexpr uint64_t kBytesPerValue = 4 * (sizeof(nlohmann::json) + 8 * sizeof(double));

// Between key `index`, of which the value is taken where u is 0, and the next.
struct KeyTime {
  uint64_t index = 0, count = 0;
  double u = 0;         // 0 <= u < 1
  double interval = 0;  // seconds to the next key
};

void require_times(const Accessor& input) {
  if (input.base.blob == nullptr || input.sparse_indices || input.count() == 0)
    fail_input(*input.path, "has an animation without times");
}

KeyTime find_key(const Accessor& input, double time) {
  require_times(input);
  KeyTime key{0, input.count()};
  ElementStream stream(input);
  std::vector<double> window(4096);
  double before = -HUGE_VAL;
  for (uint64_t i = 0; const size_t n = stream.read(std::span<double>(window));) {
    check_interrupt();
    for (size_t k = 0; k < n; ++k, ++i) {
      if (!(window[k] > before))
        fail_input(*input.path, "has an animation whose times do not ascend");
      if (window[k] <= time) {
        key = {i, input.count()};
      } else if (i > 0 && before <= time) {
        key.interval = window[k] - before;
        key.u = (time - before) / key.interval;
      }
      before = window[k];
    }
  }
  return key;
}

void normalise(Values* q) {
  double n = 0;
  for (const double c : *q) n = n + c * c;
  const double length = std::sqrt(n);
  for (double& c : *q) c = c / length;
}

Values blend(const Values& a, double of_a, const Values& b, double of_b) {
  Values sum(a.size());
  for (size_t i = 0; i < a.size(); ++i) sum[i] = of_a * a[i] + of_b * b[i];
  return sum;
}

Values slerp(Values a, Values b, double u) {
  normalise(&a);
  normalise(&b);
  double d = 0;
  for (size_t i = 0; i < a.size(); ++i) d = d + a[i] * b[i];
  const double sign = d < 0 ? -1 : 1;
  d = sign * d;
  if (!(d < kClose)) return blend(a, 1 - u, b, sign * u);
  const double angle = arc_cosine(d), whole = sine(angle);
  return blend(a, sine((1 - u) * angle) / whole, b, sign * (sine(u * angle) / whole));
}

double last_time(Accessor input) {
  require_times(input);
  input.base.begin += (input.count() - 1) * input.base.stride;
  input.base.count = 1;
  double time = 0;
  ElementStream(input).read(std::span<double>(&time, 1));
  return time;
}

class Poser {
 public:
  Poser(double time, GltfDocument* document, GltfBuffers* buffers)
      : time_(time), document_(*document), buffers_(*buffers) {}

  void apply(const JsonObject& animation) {
    const auto samplers = animation.array("samplers");
    for (const auto& value : animation.array("channels")) {
      check_interrupt();
      const JsonObject channel(value, animation.path());
      const JsonObject target = channel.object("target");
      const std::string& path = target.text("path");
      const bool is_known =
          path == "translation" || path == "rotation" || path == "scale" || path == "weights";
      if (!is_known || !target.has("node")) {
        ++not_followed_;
        continue;
      }
      const uint64_t sampler = channel.whole_number("sampler"), node = target.whole_number("node");
      if (sampler >= samplers.size())
        fail_input(animation.path(), "has an animation without its sampler");
      const JsonObject object = document_.element("nodes", node);
      if (path != "weights" && object.has("matrix"))
        fail_input(animation.path(),
                   "has an animation of nodes[" + std::to_string(node) + "], which has a matrix");
      document_.json["nodes"][size_t(node)][path] =
          sample(JsonObject(samplers[size_t(sampler)], animation.path()), path);
    }
  }
  uint64_t not_followed() const { return not_followed_; }

 private:
  Values sample(const JsonObject& sampler, const std::string& path) {
    const std::string& how = sampler.text("interpolation");
    const bool is_cubic = how == "CUBICSPLINE", is_step = how == "STEP";
    if (!is_cubic && !is_step && !how.empty() && how != "LINEAR")
      fail_input(sampler.path(), "has an animation of an unknown interpolation");
    const KeyTime key = key_of(sampler.whole_number("input"));
    const char* type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    Accessor output = buffers_.accessor(sampler.whole_number("output"), type);
    const uint64_t parts = is_cubic ? 3 : 1, keys = parts * key.count;
    const uint64_t each = path == "weights" ? output.count() / keys : 1;  // elements of a key
    if (output.sparse_indices || output.base.blob == nullptr || each == 0 ||
        output.count() != keys * each)
      fail_input(sampler.path(), "has an animation whose values do not belong to its times");
    // The values of a node and, while they are interpolated, of two keys with their tangents.
    document_.memory.resize(document_.memory.bytes() + kBytesPerValue * each, "animated nodes");
    const auto value = [&](uint64_t k, uint64_t part) {
      Accessor one = output;
      one.base.begin += (parts * k + part) * each * one.base.stride;
      one.base.count = each;
      Values values(each * one.base.components);
      ElementStream(one).read(std::span<double>(values));
      return values;
    };
    const Values here = value(key.index, is_cubic ? 1 : 0);
    if (key.u == 0 || is_step) return here;
    const Values next = value(key.index + 1, is_cubic ? 1 : 0);
    const double u = key.u;
    if (!is_cubic) return path == "rotation" ? slerp(here, next, u) : blend(here, 1 - u, next, u);
    const double u2 = u * u, u3 = u2 * u;
    const Values values = blend(here, 2 * u3 - 3 * u2 + 1, next, 3 * u2 - 2 * u3);
    const Values tangents = blend(value(key.index, 2), key.interval * (u3 - 2 * u2 + u),
                                  value(key.index + 1, 0), key.interval * (u3 - u2));
    return blend(values, 1, tangents, 1);
  }

  // Samplers share their times: each is looked up once.
  const KeyTime& key_of(uint64_t input) {
    const auto [at, is_new] = keys_.try_emplace(input);
    if (is_new) at->second = find_key(buffers_.accessor(input, "SCALAR"), time_);
    return at->second;
  }

  double time_;
  GltfDocument& document_;
  GltfBuffers& buffers_;
  std::map<uint64_t, KeyTime> keys_;  // by accessor
  uint64_t not_followed_ = 0;
};

}  // namespace

uint64_t pose_at(const PoseTime& when, GltfDocument* document, GltfBuffers* buffers) {
  Poser poser(when.seconds, document, buffers);
  const auto animations = document->root().array("animations");
  bool found = false;
  std::string names;
  for (size_t i = 0; i < animations.size(); ++i) {
    const JsonObject animation(animations[i], document->file->path());
    const std::string& name = animation.text("name");
    if (i < 10) names += (i == 0 ? " " : ", ") + (name.empty() ? "#" + std::to_string(i) : name);
    if (when.animation != "all" && when.animation != name &&
        when.animation != "#" + std::to_string(i))
      continue;
    found = true;
    poser.apply(animation);
  }
  if (!found)
    fail_usage("--animation " + when.animation + ": " + document->file->path() +
               (names.empty() ? " has no animations" : " has only these:" + names));
  return poser.not_followed();
}

std::vector<Animation> gltf_animations(const File& content, const ReadOptions& options) {
  const Tile tile(content, options.budget);
  const GltfDocument document =
      load_gltf(tile.gltf_file(), options.budget, {.animations = true}, tile.gltf_bytes());
  GltfBuffers buffers(document, options.budget, options.spill, options.sandbox);
  std::vector<Animation> animations;
  for (const auto& value : document.root().array("animations")) {
    const JsonObject object(value, document.file->path());
    Animation animation{.name = object.text("name")};
    for (const auto& sampler : object.array("samplers")) {
      const JsonObject keys(sampler, document.file->path());
      animation.seconds = std::max(
          animation.seconds, last_time(buffers.accessor(keys.whole_number("input"), "SCALAR")));
    }
    std::set<uint64_t> nodes, weights;
    for (const auto& each : object.array("channels")) {
      const JsonObject target = JsonObject(each, document.file->path()).object("target");
      if (!target.has("node")) continue;
      (target.text("path") == "weights" ? weights : nodes).insert(target.whole_number("node"));
    }
    animation.nodes = nodes.size();
    animation.weights = weights.size();
    animations.push_back(std::move(animation));
  }
  return animations;
}

}  // namespace svdag
