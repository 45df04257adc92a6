#include "builder/farm/planner/print_plan.h"

#include <algorithm>
#include <cstdio>

#include "builder/farm/planner/predict.h"
#include "io/units.h"
#include "streaming/printable.h"
#include "streaming/process/shell.h"

namespace svdag {
namespace {

struct Totals {
  double cpu = 0, longest = 0;
  uint64_t memory = 0, scratch = 0;  // max of one step
  uint64_t output = 0;
  size_t steps = 0;

  void add(const Prediction& p) {
    cpu += p.cpu;
    longest = std::max(longest, p.seconds);
    memory = std::max(memory, p.memory);
    scratch = std::max(scratch, p.scratch);
    output += p.output;
    ++steps;
  }
};

void print_totals(const char* what, const Totals& totals) {
  std::printf(
      "  %3zu %s: %.2f CPU seconds, the longest takes %.2f s; memory at most %s; output %s%s\n",
      totals.steps, what, totals.cpu, totals.longest, format_bytes(totals.memory).c_str(),
      format_bytes(totals.output).c_str(),
      totals.scratch != 0 ? (", scratch at most " + format_bytes(totals.scratch)).c_str() : "");
}

// Seconds of the longest chain of steps: the time of the plan with a machine per step.
double critical_path(const Plan& plan) {
  std::vector<double> ends;
  for (const PlanStep& step : plan.steps) {
    double begin = 0;
    for (const size_t i : step.inputs) begin = std::max(begin, ends[i]);
    ends.push_back(begin + step.predicted.seconds);
  }
  return ends.empty() ? 0 : ends.back();
}

void print_steps(const Plan& plan) {
  std::printf("\n  %-12s %8s %8s %10s %10s %10s  %s\n", "step", "CPU s", "seconds", "memory",
              "output", "scratch", "command");
  for (const PlanStep& step : plan.steps) {
    const Prediction& p = step.predicted;
    std::vector<std::string> words = plan.command(step);
    words.insert(words.begin(), "svdag");
    const std::string command = printable(shell_words(words));
    std::printf("  %-12s %8.2f %8.2f %10s %10s %10s  %s\n", step.name.c_str(), p.cpu, p.seconds,
                format_bytes(p.memory).c_str(), format_bytes(p.output).c_str(),
                format_bytes(p.scratch).c_str(), plan.folder.empty() ? "" : command.c_str());
  }
}

uint64_t expected_memory(const Plan& plan, const Prediction& bake) {
  return std::min(plan.one_bake.memory, bake.memory);
}

}  // namespace

void print_plan(const Plan& plan, bool steps) {
  Totals shards, merges, colours;
  for (const PlanStep& step : plan.steps)
    (step.is_shard() ? shards : step.is_merge() ? merges : colours).add(step.predicted);
  std::printf("%s%s^3, %s in %s; one bake would take %.2f CPU seconds\n",
              plan.folder.empty() ? "" : (plan.folder + ": ").c_str(),
              format_resolution(uint64_t(plan.grid.resolution())).c_str(),
              format_count(plan.counts.scene.triangles, "triangle").c_str(),
              format_count(plan.bins.size(), "bin").c_str(), plan.one_bake.cpu);
  print_totals(shards.steps == 1 ? "shard" : "shards", shards);
  print_totals(merges.steps == 1 ? "merge" : "merges", merges);
  if (plan.colours) print_totals("colour pass", colours);
  std::printf("  with a machine per step: %.2f s\n", critical_path(plan));
  if (steps) print_steps(plan);
}

// With colours, the file of the bake is in scratch until they are in.
Prediction bake_of(const Plan& plan) {
  Prediction p = plan.steps.front().predicted;
  p.cpu = plan.one_bake.cpu;
  p.seconds = seconds_of_bake(p.cpu, plan.counts.scene.triangles, plan.steps.front().threads);
  const Prediction& last = plan.steps.back().predicted;
  p.output = last.output;
  if (!plan.colours) return p;
  p.budget = std::max(p.budget, last.budget);
  p.memory = std::max(p.memory, last.memory);
  const Prediction& merge = plan.steps[plan.steps.back().inputs.front()].predicted;
  p.scratch = std::max(p.scratch, merge.output + last.scratch);
  return p;
}

void print_bake_json(const Plan& plan, const FreeDisk& disk) {
  const PlanStep& step = plan.steps.front();
  const Prediction p = bake_of(plan);
  const auto whole = [](uint64_t n) { return static_cast<unsigned long long>(n); };
  std::printf(
      "{\"resolution\": %llu, \"triangles\": %llu, \"cells\": %llu, \"threads\": %zu, "
      "\"cpu_seconds\": %.3f, \"seconds\": %.3f, \"budget_bytes\": %llu, \"memory_bytes\": %llu, "
      "\"expected_memory_bytes\": %llu, "
      "\"output_bytes\": %llu, \"output_free_bytes\": %llu, \"scratch_bytes\": %llu, "
      "\"scratch_free_bytes\": %llu}\n",
      whole(uint64_t(plan.grid.resolution())), whole(plan.counts.scene.triangles),
      whole(plan.one_bake.cells), step.threads, p.cpu, p.seconds, whole(p.budget), whole(p.memory),
      whole(expected_memory(plan, p)), whole(p.output), whole(disk.output_bytes), whole(p.scratch),
      whole(disk.scratch_bytes));
}

void print_bake(const Plan& plan, const FreeDisk& disk, bool default_memory) {
  const Prediction p = bake_of(plan);
  std::printf("%s: %s^3, %s in %s\n", printable(disk.output).c_str(),
              format_resolution(uint64_t(plan.grid.resolution())).c_str(),
              format_count(plan.counts.scene.triangles, "triangle").c_str(),
              format_count(plan.one_bake.cells, "cell").c_str());
  std::printf("  about %.2f CPU seconds, %.2f s on %s\n", p.cpu, p.seconds,
              format_count(plan.steps.front().threads, "thread").c_str());
  std::printf("  a file of about %s, scratch of about %s\n", format_bytes(p.output).c_str(),
              format_bytes(p.scratch).c_str());
  if (p.output > disk.output_bytes)
    std::printf("  not enough disk space for the file: %s free\n",
                format_bytes(disk.output_bytes).c_str());
  if (p.scratch > disk.scratch_bytes)
    std::printf("  not enough disk space for scratch: %s free (choose another with --scratch)\n",
                format_bytes(disk.scratch_bytes).c_str());
  std::printf("  memory of about %s, at most %s with --memory %lluM%s\n",
              format_bytes(expected_memory(plan, p)).c_str(), format_bytes(p.memory).c_str(),
              static_cast<unsigned long long>(p.budget >> 20),
              default_memory ? " (not given: half of the machine's may be used)" : "");
}

}  // namespace svdag
