// svdag-trace: the tracer alone, on the processor or a GPU; needs no third-party library.
#include <cstdio>
#include <optional>

#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/file_names.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/process/program.h"
#include "verify/trace/program/device.h"
#include "verify/trace/program/trace_options.h"

namespace svdag {
namespace {

// The result of a pixel, as --dump writes it. The number of steps is not part of it.
struct Record {
  uint32_t found, voxel[3], level, axis;
  double t;
  uint32_t blocked[3], zero[3];
};
static_assert(sizeof(Record) == 56);

Record record_of(const Answers& answers, size_t pixel) {
  const Hit& hit = answers.hits[pixel];
  Record record{hit.found, {hit.voxel[0], hit.voxel[1], hit.voxel[2]},
                hit.level, uint32_t(hit.axis),
                hit.t,     {},
                {}};
  for (int i = 0; i < 3; ++i) record.blocked[i] = answers.blocked[kShadowRays + i][pixel];
  return record;
}

// Equal as bits: a time of -0 differs from 0.
bool same(const Record& a, const Record& b) {
  const auto* x = reinterpret_cast<const unsigned char*>(&a);
  const auto* y = reinterpret_cast<const unsigned char*>(&b);
  for (size_t i = 0; i < sizeof(Record); ++i) {
    if (x[i] != y[i]) return false;
  }
  return true;
}

uint64_t hash_of(const Answers& answers) {
  uint64_t hash = 0;
  for (size_t pixel = 0; pixel < answers.hits.size(); ++pixel) {
    const Record record = record_of(answers, pixel);
    const auto* words = reinterpret_cast<const uint32_t*>(&record);
    for (size_t i = 0; i < sizeof(Record) / 4; ++i) hash = mix(hash * 31 + words[i]);
  }
  return hash;
}

void print(const Answers& answers) {
  std::printf("%s\n%-8s %12s %12s %9s %9s\n", answers.device.c_str(), "workload", "rays", "hit",
              "seconds", "MRays/s");
  for (int kind = 0; kind < kWorkloads; ++kind) {
    uint64_t hit = 0;
    for (size_t pixel = 0; pixel < answers.hits.size(); ++pixel)
      hit += kind == kPrimaryRays ? answers.hits[pixel].found : answers.blocked[kind][pixel];
    const double seconds = answers.seconds[kind];
    std::printf("%-8s %12llu %12llu %9.4f %9.2f\n", kWorkloadNames[kind],
                static_cast<unsigned long long>(answers.rays[kind]),
                static_cast<unsigned long long>(hit), seconds,
                seconds > 0 ? 1e-6 * double(answers.rays[kind]) / seconds : 0.0);
  }
  std::printf("answers  %016llx\n", static_cast<unsigned long long>(hash_of(answers)));
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

std::string dump_of(const Answers& answers) {
  std::string bytes;
  for (size_t pixel = 0; pixel < answers.hits.size(); ++pixel) {
    const Record record = record_of(answers, pixel);
    bytes.append(reinterpret_cast<const char*>(&record), sizeof record);
  }
  return bytes;
}

// Soft light by Lambert, times ambient occlusion, over grey.
std::string picture_of(const Answers& answers, const Workload& work) {
  std::string bytes = "P6\n" + std::to_string(work.picture.width) + " " +
                      std::to_string(work.picture.height) + "\n255\n";
  const double n = work.secondary.samples;
  for (size_t pixel = 0; pixel < answers.hits.size(); ++pixel) {
    const Surfel& surfel = answers.surfels[pixel];
    double grey = 0.75;
    if (surfel.found) {
      const double facing = dot(surfel.normal, normalized(work.light.centre - surfel.point));
      const double sun = (1 - answers.blocked[kSoftRays][pixel] / n) * (facing > 0 ? facing : 0);
      const double sky = 1 - answers.blocked[kOcclusionRays][pixel] / n;
      grey = square_root(0.45 * sun + 0.5 * sky);
    }
    bytes.append(3, char(uint8_t(255 * (grey < 1 ? grey : 1))));
  }
  return bytes;
}

int compare(const Answers& cpu, const Answers& gpu) {
  size_t different = 0;
  for (size_t pixel = 0; pixel < cpu.hits.size(); ++pixel) {
    if (same(record_of(cpu, pixel), record_of(gpu, pixel))) continue;
    if (different++ > 0) continue;
    std::printf("first differing pixel: number %zu, t %.17g and %.17g\n", pixel, cpu.hits[pixel].t,
                gpu.hits[pixel].t);
  }
  std::printf("%zu of %zu pixels differ\n", different, cpu.hits.size());
  return int(different == 0 ? ExitCode::kOk : ExitCode::kDiffers);
}

// No output may be the input or the other output, whatever they are called.
void check_outputs(const TraceOptions& options) {
  FileNames written;
  for (const std::string& output : {options.dump, options.picture}) {
    if (output.empty()) continue;
    if (same_file(options.file, output))
      fail_usage(output + ": is the input; choose another name for the output");
    if (written.find(output) != nullptr)
      fail_usage(output + ": would be written twice; choose another name for one of the outputs");
    written.add(output);
    AtomicFile::check(output);
  }
}

// Overcommitted pages that are not available kill a program without a message, so this is checked
// before: results may take half of the memory, and the rest is for the file. Returns the rest.
uint64_t room_for_file(const TraceOptions& options) {
  const uint64_t half = default_memory_limit();
  const uint64_t pixel = kAnswerBytes + (options.dump.empty() ? 0 : sizeof(Record));
  const uint64_t answers =
      (options.compare ? 2 : 1) * pixel * uint64_t(options.width) * options.height;
  if (answers > half)
    throw Error(ExitCode::kMemory,
                "--size: the answers of so many pixels do not fit in half of the memory; "
                "choose fewer");
  return 2 * half - answers;
}

int run(const TraceOptions& options) {
  check_outputs(options);
  const PlainFile file = read_plain_file(options.file, room_for_file(options));
  const Workload work = make_workload(options, file);
  Output dump(options.dump), picture(options.picture);
  int result = 0;
  Answers answers;
  if (options.compare) {
    const Answers gpu = trace_on_cuda(file, work);
    answers = trace_on_cpu(file, work);
    print(answers);
    print(gpu);
    result = compare(answers, gpu);
  } else {
    answers = options.device == "cuda" ? trace_on_cuda(file, work) : trace_on_cpu(file, work);
    print(answers);
  }
  dump.write([&] { return dump_of(answers); });
  picture.write([&] { return picture_of(answers, work); });
  dump.commit();
  picture.commit();
  return result;
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  return svdag::run_program({"svdag-trace", "this machine has too little memory for that"}, [&] {
    const auto options = svdag::parse_trace_options(argc, argv);
    return options ? svdag::run(*options) : 0;
  });
}
