#include <cmath>
#include <cstdio>

#include "io/dag/open_dag.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"
#include "verify/commands/commands.h"
#include "verify/report/report_html.h"
#include "verify/trace/cpu.h"
#include "verify/trace/presets.h"

namespace svdag {
namespace {

constexpr uint64_t kPageBytes = uint64_t(4) << 20;  // with the viewer, unless pictures are larger

// What the page's other parts leave for the viewer's tiles.
uint64_t tile_bytes(const std::vector<ReportPicture>& pictures) {
  uint64_t others = uint64_t(128) << 10;
  for (const ReportPicture& picture : pictures) others += picture.png.size() * 4 / 3;
  return others < kPageBytes / 2 ? kPageBytes - others : kPageBytes / 2;
}

std::string read_text(const std::string& path) {
  constexpr uint64_t kMaxBytes = uint64_t(16) << 20;
  const File file = File::open_read(path);
  if (file.size() > kMaxBytes) fail_input(path, "is too large for a report or a verdict");
  return file.text();
}

std::vector<ReportPicture> make_pictures(const ReportConfig& config, const DagFile& file) {
  struct View {
    const char *caption, *preset;
    ShadeMode mode;
  };
  constexpr View kViews[] = {{"From above, with soft shadows", "iso", ShadeMode::kSoft},
                             {"From inside, ambient occlusion", "inside", ShadeMode::kAo},
                             {"The level at which rays end", "inside", ShadeMode::kLevel},
                             {"Directions of the surface", "iso", ShadeMode::kNormal}};
  std::vector<ReportPicture> pictures;
  const DagView& dag = file.view();
  if (dag.empty()) return pictures;
  RenderConfig picture;
  picture.width = config.size.width;
  picture.height = config.size.height;
  picture.supersample = 2;  // without moire on fine walls
  const ShownColours colours(file);
  colours.show_in(&picture);
  const VoxelBounds box = framing_bounds(dag);
  ParallelExecutor executor(threads_or_all(config.common.threads));
  Progress progress(config.common.progress);
  for (const View& view : kViews) {
    const Camera camera =
        preset_camera(view.preset, dag, box, config.up, Camera::kDefaultFov, config.size.aspect());
    Shading shading = make_shading(view.mode, dag, camera, config.up, box);
    shading.pixel = 2 * camera.slope / picture.height;
    shading.secondary.samples = 2;  // for each of four rays per pixel
    shading.secondary.reach = 0.05 * length(box.max - box.min);
    if (view.mode == ShadeMode::kLevel) shading.primary.spread = shading.pixel;
    const Image image = render(dag, {}, camera, shading, picture, executor, progress);
    pictures.push_back({view.caption, encode_png(image, config.output)});
  }
  return pictures;
}

}  // namespace

int run(const ReportConfig& config) {
  const Stopwatch stopwatch(config.common);
  CommandFiles files(config.inputs);
  files.read(config.file);
  files.write(config.output);
  AtomicFile output(
      config.output);  // opened first, so that no work is lost if it cannot be written
  const DagFile file = open_dag(config.file);
  std::vector<ReportInput> json;
  for (const std::string& path : config.inputs) json.push_back({path, read_text(path)});
  MemoryBudget budget(memory_or_default(0));
  const IntegrityReport integrity = inspect_file(file, temporary_room(&budget));
  const DagStats stats = compute_stats(file);
  report_html(json, file, stats, integrity, {});  // rejects a wrong input before rendering
  ParallelExecutor executor(threads_or_all(config.common.threads));
  const std::vector<ReportPicture> pictures = make_pictures(config, file);
  const EmbeddedViewer viewer = embed_viewer(file, config.up, tile_bytes(pictures), executor);
  const ReportPage page = report_html(json, file, stats, integrity, pictures, viewer);
  output.append(page.html);
  output.commit();
  if (!config.common.quiet)
    std::printf("%s: %s\n", printable(config.output).c_str(),
                !integrity.sound() ? "not sound"
                : page.ok          ? "sound"
                                   : "sound, but a verdict is not ok");
  return int(page.ok ? ExitCode::kOk : ExitCode::kDiffers);
}

}  // namespace svdag
