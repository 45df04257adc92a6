#include "builder/commands/command_scene.h"

#include <cstdio>

#include "builder/farm/plan/plan_folder.h"
#include "io/units.h"
#include "streaming/file/checksum.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/printable.h"
#include "streaming/spill/scratch_dir.h"

namespace svdag {

namespace {

std::string triangles_are(uint64_t count) {
  return format_count(count, "triangle") + (count == 1 ? " is" : " are");
}

}  // namespace

void print_scene_notes(const SceneCounts& counts) {
  for (const std::string& pattern : counts.unmatched)
    std::printf("  no part of the scene matches %s\n", printable(pattern).c_str());
  for (const std::string& image : counts.unread_images)
    std::printf("  no colour from a texture: %s\n", printable(image).c_str());
  for (size_t i = 0; i < kOmissionCount; ++i) {
    if (counts.left_out[i] > 0) std::printf("  %s\n", omission_text(i, counts.left_out[i]).c_str());
  }
  if (counts.cut > 0)
    std::printf("  %s cut out by the alpha of their material\n", triangles_are(counts.cut).c_str());
  if (counts.undeformed > 0)
    std::printf("  %s read as stored: skins and morph targets are not applied\n",
                triangles_are(counts.undeformed).c_str());
}

void print_colours(const ColourReport& report) {
  const Header& header = report.header;
  const uint64_t bytes = header.chunks_bytes + header.directory_bytes;
  std::printf("%s down to level %u, %s", format_count(header.colour_count, "colour").c_str(),
              header.colour_level, format_bytes(bytes).c_str());
  if (header.colour_count > 0)
    std::printf(" (%.3g bits each)", 8 * double(bytes) / double(header.colour_count));
  if (report.texels_per_cube > 0) std::printf(", a cube spans %.2g texels", report.texels_per_cube);
  std::printf("\n");
}

void print_colour_hash(const ColourReport& report) {
  std::printf("  colour hash %s\n", to_hex(report.header.colour_hash).c_str());
}

void print_nothing_to_resume(const std::string& output, const std::string& scratch) {
  std::printf("  nothing to resume in %s: it was made anew\n",
              printable(ScratchDir::path_for(output, scratch)).c_str());
}

std::map<std::string, uint64_t> left_out_json(const LeftOut& left_out) {
  std::map<std::string, uint64_t> counts;
  visit_left_out(left_out, [&](const char* name, uint64_t count) {
    if (count > 0) counts[name] = count;
  });
  return counts;
}

void read_buffers(const SceneConfig& scene, uint64_t memory, CommandFiles* files) {
  MemoryBudget budget(memory_or_default(memory));
  Scene(scene, &budget).visit_files([&](const File& file) { files->read(file.path()); });
}

void read_plan(const Plan& plan, const PlanStep* own, CommandFiles* files) {
  for (const std::string& file : files_of(plan)) {
    if (own == nullptr || file != plan.path(own->output)) files->read(file);
  }
  for (const PlanInput& input : plan.inputs) files->read(input.path);
}

}  // namespace svdag
