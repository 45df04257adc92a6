// The program svdag-trace: only the tracer, on the processor or a GPU. Loads no third-party
// library.
#include <cinttypes>
#include <cstdio>
#include <optional>

#include "io/dag/colours/dag_colours.h"
#include "io/units.h"
#include "io/verdict.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/printable.h"
#include "streaming/process/program.h"
#include "verify/trace/program/device.h"
#include "verify/trace/program/trace_options.h"
#include "verify/trace/shade.h"

namespace svdag {
namespace {

// The result of a pixel, as --dump writes it. The number of steps is not part of it.
struct PixelRecord {
  uint32_t found, voxel[3], level, axis;
  double t;
  uint32_t blocked[3], layer_and_one, zero[2];
};
static_assert(sizeof(PixelRecord) == 56);

PixelRecord record_of(const TraceResults& results, size_t pixel) {
  const Hit& hit = results.hits[pixel];
  PixelRecord record{hit.found,
                     {hit.voxel[0], hit.voxel[1], hit.voxel[2]},
                     hit.level,
                     uint32_t(hit.axis),
                     hit.t,
                     {},
                     results.layers[pixel] + 1,
                     {}};
  for (int i = 0; i < 3; ++i) record.blocked[i] = results.blocked[kShadowRays + i][pixel];
  return record;
}

// Bitwise equality: a time of -0 differs from 0.
bool same(const PixelRecord& a, const PixelRecord& b) {
  const auto* x = reinterpret_cast<const unsigned char*>(&a);
  const auto* y = reinterpret_cast<const unsigned char*>(&b);
  for (size_t i = 0; i < sizeof(PixelRecord); ++i) {
    if (x[i] != y[i]) return false;
  }
  return true;
}

uint64_t hash_of(const TraceResults& results) {
  uint64_t hash = 0;
  for (size_t pixel = 0; pixel < results.hits.size(); ++pixel) {
    const PixelRecord record = record_of(results, pixel);
    const auto* words = reinterpret_cast<const uint32_t*>(&record);
    for (size_t i = 0; i < sizeof(PixelRecord) / 4; ++i) hash = mix(hash * 31 + words[i]);
  }
  return hash;
}

uint64_t hits_of(const TraceResults& results, int kind) {
  uint64_t hits = 0;
  for (size_t pixel = 0; pixel < results.hits.size(); ++pixel)
    hits += kind == kPrimaryRays ? results.hits[pixel].found : results.blocked[kind][pixel];
  return hits;
}

// Adds the figures of one device. `at` is where JSON has them: "", or "cuda/" in a comparison.
void report(const TraceResults& results, const LayerTable& table, const std::string& at,
            Verdict* verdict) {
  const auto line = [&](const char* format, auto... values) {
    char text[128];
    std::snprintf(text, sizeof text, format, values...);
    verdict->for_people("", text);
  };
  verdict->for_programs(at + "device", results.device);
  verdict->for_people("", printable(results.device));
  line("%-8s %12s %12s %9s %9s", "workload", "rays", "hit", "seconds", "MRays/s");
  for (int kind = 0; kind < kWorkloads; ++kind) {
    const uint64_t rays = results.rays[kind], hits = hits_of(results, kind);
    const double seconds = results.seconds[kind];
    line("%-8s %12" PRIu64 " %12" PRIu64 " %9.4f %9.2f", kWorkloadNames[kind], rays, hits, seconds,
         seconds > 0 ? 1e-6 * double(rays) / seconds : 0.0);
    const std::string work = at + "workloads/" + std::to_string(kind) + "/";
    verdict->for_programs(work + "workload", kWorkloadNames[kind]);
    verdict->for_programs(work + "rays", rays);
    verdict->for_programs(work + "hit", hits);
    verdict->for_programs(work + "seconds", seconds);
  }
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016" PRIx64, hash_of(results));
  verdict->for_programs(at + "results", hash);
  line("results  %s", hash);
  std::vector<uint64_t> hits(table.layers.size());
  for (const uint32_t layer : results.layers)
    if (layer != kNoLayer) ++hits[layer];
  for (size_t i = 0; i < hits.size(); ++i) {
    const std::string layer = at + "layers/" + std::to_string(i) + "/";
    verdict->for_programs(layer + "name", table.layers[i].name);
    verdict->for_programs(layer + "hit", hits[i]);
  }
}

// An optional output file, opened before the work, so that no work is lost if it cannot be written.
class Output {
 public:
  explicit Output(const std::string& path) {
    if (!path.empty()) file_.emplace(path);
  }
  template <typename Bytes>
  void write(const Bytes& bytes) {
    if (file_) file_->append(std::string_view(bytes()));
  }
  void commit() {
    if (file_) file_->commit();
  }

 private:
  std::optional<AtomicFile> file_;
};

std::string dump_of(const TraceResults& results) {
  std::string bytes;
  for (size_t pixel = 0; pixel < results.hits.size(); ++pixel) {
    const PixelRecord record = record_of(results, pixel);
    bytes.append(reinterpret_cast<const char*>(&record), sizeof record);
  }
  return bytes;
}

// The part of light that what a pixel shows reflects: the file's colours, else those of its layers,
// else white.
Vec3 albedo_of_pixel(const TraceResults& results, size_t pixel, const PlainFile& file,
                     const DagColours* colours) {
  if (colours != nullptr) {
    const Hit& hit = results.hits[pixel];
    const uint32_t shift = file.view.levels - hit.level;
    const uint32_t colour = svdag_colour(colours->view(), hit.level, hit.voxel[0] >> shift,
                                         hit.voxel[1] >> shift, hit.voxel[2] >> shift);
    if (colour != kNoColour)
      return albedo_of({uint8_t(colour), uint8_t(colour >> 8), uint8_t(colour >> 16)});
  } else if (results.layers[pixel] != kNoLayer) {
    return albedo_of(file.layers.layers[results.layers[pixel]].colour);
  }
  return Vec3{{1, 1, 1}};
}

// Lambert shading by the soft light, plus ambient occlusion.
std::string picture_of(const TraceResults& results, const Workload& work, const PlainFile& file,
                       const std::string& path) {
  MemoryBudget budget;
  std::optional<DagColours> colours;
  if (has_colours(file.header())) colours.emplace(file.words.data(), path, &budget);
  std::string bytes = "P6\n" + std::to_string(work.picture.width) + " " +
                      std::to_string(work.picture.height) + "\n255\n";
  const double n = work.secondary.samples;
  for (size_t pixel = 0; pixel < results.hits.size(); ++pixel) {
    const Surfel& surfel = results.surfels[pixel];
    Vec3 colour{{0.75, 0.75, 0.75}};
    if (surfel.found) {
      const double facing = dot(surfel.normal, normalized(work.light.centre - surfel.point));
      const double sun = (1 - results.blocked[kSoftRays][pixel] / n) * (facing > 0 ? facing : 0);
      const double sky = 1 - results.blocked[kOcclusionRays][pixel] / n;
      const Vec3 albedo = albedo_of_pixel(results, pixel, file, colours ? &*colours : nullptr);
      for (int c = 0; c < 3; ++c) colour[c] = square_root(albedo[c] * (0.45 * sun + 0.5 * sky));
    }
    for (int c = 0; c < 3; ++c) bytes += char(uint8_t(255 * (colour[c] < 1 ? colour[c] : 1)));
  }
  return bytes;
}

// Adds the comparison, and returns the number of pixels that differ.
size_t report_differences(const TraceResults& cpu, const TraceResults& gpu, Verdict* verdict) {
  size_t different = 0, first = 0;
  for (size_t pixel = cpu.hits.size(); pixel-- > 0;) {
    if (same(record_of(cpu, pixel), record_of(gpu, pixel))) continue;
    ++different;
    first = pixel;
  }
  if (different != 0)
    verdict->for_people("", "first differing pixel: " + std::to_string(first) + ", t " +
                                format_double(cpu.hits[first].t) + " and " +
                                format_double(gpu.hits[first].t));
  verdict->for_people(
      "", std::to_string(different) + " of " + std::to_string(cpu.hits.size()) + " pixels differ");
  verdict->for_programs("pixels", cpu.hits.size());
  verdict->for_programs("different", different);
  return different;
}

// Rejects outputs that are the input or each other, under any name.
void check_outputs(const TraceOptions& options) {
  CommandFiles files({options.file});
  for (const std::string& output : {options.dump, options.picture}) {
    if (output.empty()) continue;
    files.write(output);
    AtomicFile::check(output);
  }
}

// Returns the memory for the file: the results may take half of the machine's, and the file gets
// the rest. Checked up front, because a program that touches overcommitted pages is killed without
// a message.
uint64_t memory_for_file(const TraceOptions& options) {
  const uint64_t half = default_memory_limit();
  const uint64_t pixel_bytes =
      kResultBytesPerPixel + (options.dump.empty() ? 0 : sizeof(PixelRecord));
  const uint64_t results = (options.compare ? 2 : 1) * pixel_bytes *
                           uint64_t(options.view.size.width) * uint64_t(options.view.size.height);
  if (results > half)
    throw Error(ExitCode::kMemory, "--size: the results of " +
                                       std::to_string(options.view.size.width) + "x" +
                                       std::to_string(options.view.size.height) +
                                       " pixels do not fit in half of the memory: choose fewer");
  return 2 * half - results;
}

int run(const TraceOptions& options) {
  check_outputs(options);
  PlainFile file = read_plain_file(options.file, memory_for_file(options));
  if (!options.layers.empty()) {
    const std::vector<size_t> chosen = layers_named(file.layers, options.layers);
    if (chosen.size() > 1)
      fail_usage("--layer: one layer can be traced: make a file of several with svdag convert");
    show_layer(&file, chosen.front());
  }
  const Workload work = make_workload(options, file);
  Output dump(options.dump), picture(options.picture);
  Verdict verdict;
  const bool on_cpu = options.compare || options.device != "cuda";
  const TraceResults gpu = options.compare ? trace_on_cuda(file, work) : TraceResults();
  const TraceResults results = on_cpu ? trace_on_cpu(file, work) : trace_on_cuda(file, work);
  report(results, file.layers, options.compare ? "cpu/" : "", &verdict);
  if (options.compare) report(gpu, file.layers, "cuda/", &verdict);
  const bool differs = options.compare && report_differences(results, gpu, &verdict) != 0;
  std::printf("%s", (options.json ? verdict.json() + "\n" : verdict.text()).c_str());
  dump.write([&] { return dump_of(results); });
  picture.write([&] { return picture_of(results, work, file, options.file); });
  dump.commit();
  picture.commit();
  return int(differs ? ExitCode::kDiffers : ExitCode::kOk);
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  return svdag::run_program({"svdag-trace", "not enough memory on this machine"}, [&] {
    const auto options = svdag::parse_trace_options(argc, argv);
    return options ? svdag::run(*options) : 0;
  });
}
