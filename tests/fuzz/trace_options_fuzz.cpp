// Arbitrary bytes as a command line of svdag-trace, one word per line: the result is a workload of
// finite rays, or an Error (usage).
#include <cmath>
#include <cstdlib>

#include "tests/fuzz/file_fuzz.h"
#include "tests/verify/raw_dag.h"
#include "verify/trace/program/trace_options.h"

namespace svdag {
namespace {

constexpr size_t kWordLimit = 64;

PlainFile small_file() {
  const RawFile raw(raw_dag(test_grid(4), {{1, 2, 3}, {9, 10, 11}, {15, 15, 0}}));
  PlainFile file;
  file.words.resize((raw.bytes().size() + 7) / 8);
  std::memcpy(file.words.data(), raw.bytes().data(), raw.bytes().size());
  file.view = dag_view(file.words.data());
  return file;
}

void require(bool condition) {
  if (!condition) std::abort();
}

void require_finite(const Vec3& v) {
  for (int a = 0; a < 3; ++a) require(std::isfinite(v[a]));
}

void check(const Workload& work) {
  const Picture& picture = work.picture;
  for (const uint32_t side : {picture.width, picture.height}) require(side >= 1 && side <= 16384);
  for (const auto& [x, y] : {std::pair(0U, 0U), std::pair(picture.width - 1, picture.height - 1)}) {
    const Ray ray = picture.ray(x, y);
    require_finite(ray.origin);
    require_finite(ray.direction);
  }
  const Surfel surfel{true, {{1, 2, 3}}, {{0, 0, 1}}};
  for (const uint64_t pixel : {0U, 77U}) {
    require_finite(shadow_ray(surfel, work.light).direction);
    require_finite(soft_ray(surfel, work.light, pixel, 0, work.secondary.samples).direction);
  }
  require(work.secondary.samples >= 1 && work.rounds >= 1 && work.threads <= 1024);
  require(work.secondary.reach > 0 && std::isfinite(work.secondary.cut.spread));
}

void try_words(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  const auto options = parse_trace_options(int(argv.size()), argv.data());
  if (!options) return;
  static const PlainFile file = small_file();
  check(make_workload(*options, file));
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  std::vector<std::string> words = {"svdag-trace"};
  for (size_t i = 0; i < size && words.size() < kWordLimit; ++i) {
    if (i == 0 || data[i] == '\n') words.emplace_back();
    if (data[i] != '\n' && data[i] != 0) words.back() += char(data[i]);
  }
  expect_only_errors([&] { try_words(std::move(words)); }, ExitCode::kUsage);
  return 0;
}
