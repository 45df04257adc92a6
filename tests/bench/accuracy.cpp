// The program of `make bench-accuracy`: run time against error, a line of CSV per case, method and
// input.
//
// Time is CPU time of one thread over all cells of a case, including the set-up of the triangles:
// the minimum of several rounds, which are interleaved between methods so that other load affects
// all alike. Errors are counted against the judge on the same cells.
#include <ctime>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "io/units.h"
#include "streaming/error.h"
#include "tests/bench/accuracy_methods.h"

namespace svdag::bench {
namespace {

constexpr int kRounds = 5;
constexpr int kBakeRounds = 2;

// Command line, for profiling: `accuracy_bench [PART-OF-CASE-NAME [METHOD [ROUNDS]]]`.
struct RunFilter {
  std::string case_part;
  std::string method;
  int rounds = kRounds;
};

struct Measured {
  uint64_t cells = 0, pairs = 0, voxels = 0;
  Difference error;
  double seconds = std::numeric_limits<double>::infinity();
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// Runs one round of one method over the cells of a case.
Measured run_once(const Case& c, const Method& method, Input input) {
  Measured m;
  m.seconds = 0;
  BrickList found;
  for (size_t i = 0; i < c.cells.size(); i += method.slow ? 8 : 1) {
    const CellWork& work = c.cells[i];
    found.clear();
    const double start = cpu_seconds();
    method.run(work, input, &found);
    m.seconds += cpu_seconds() - start;
    const Difference difference = compare(work.truth, found);
    m.error.misses += difference.misses;
    m.error.extras += difference.extras;
    m.pairs += work.pairs;
    m.voxels += work.voxels;
    ++m.cells;
  }
  return m;
}

void print(const Case& c, const std::string& method, const char* input, const Measured& m) {
  std::printf("\"%s\",%s,%s,\"%s\",%s,%ju,%ju,%ju,%ju,%ju,%.6f,%.2f\n", c.name.c_str(),
              c.group.c_str(), format_resolution(uint64_t(c.grid.resolution())).c_str(),
              method.c_str(), input, uintmax_t(m.cells), uintmax_t(m.voxels), uintmax_t(m.pairs),
              uintmax_t(m.error.misses), uintmax_t(m.error.extras), m.seconds,
              m.seconds * 1e9 / double(m.pairs));
  std::fflush(stdout);
}

void run_case(const Case& c, int rounds, const RunFilter& filter) {
  if (c.name.find(filter.case_part) == std::string::npos) return;
  std::vector<Method> methods = make_methods(c.grid);
  std::erase_if(methods,
                [&](const Method& m) { return !filter.method.empty() && m.name != filter.method; });
  std::vector<Measured> world(methods.size());
  for (int round = 0; round < rounds; ++round) {
    for (size_t i = 0; i < methods.size(); ++i) {
      if (methods[i].slow && (c.group == "bake" || round > 0)) continue;
      Measured m = run_once(c, methods[i], Input::kWorld);
      m.seconds = std::min(m.seconds, world[i].seconds);
      world[i] = m;
    }
  }
  for (size_t i = 0; i < methods.size(); ++i) {
    if (methods[i].slow && c.group == "bake") continue;
    print(c, methods[i].name, "world", world[i]);
    if (c.group != "bake")
      print(c, methods[i].name, "snapped", run_once(c, methods[i], Input::kSnapped));
  }
}

int run(const RunFilter& filter) {
  std::puts(
      "case,group,grid,method,input,cells,voxels,pairs,misses,extras,cpu_seconds,ns_per_pair");
#ifndef SVDAG_HAS_CGAL
  std::fputs("built without CGAL: its two methods are skipped\n", stderr);
#endif
  for (const Case& c : family_cases()) run_case(c, filter.rounds, filter);
  const char* folder = std::getenv("SVDAG_SCENES");
  if (folder == nullptr) {
    std::fputs("SVDAG_SCENES is not set: the real scenes are skipped\n", stderr);
    return 0;
  }
  for (const Case& c : scene_cases(folder)) run_case(c, filter.rounds, filter);
  run_case(bake_case(folder), kBakeRounds, filter);
  return 0;
}

}  // namespace
}  // namespace svdag::bench

int main(int count, char** arguments) {
  svdag::bench::RunFilter filter;
  if (count > 1) filter.case_part = arguments[1];
  if (count > 2) filter.method = arguments[2];
  if (count > 3) filter.rounds = std::atoi(arguments[3]);
  try {
    return svdag::bench::run(filter);
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
