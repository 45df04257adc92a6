#include "verify/trace/program/trace_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "io/suggest.h"
#include "streaming/error.h"
#include "verify/trace/program/picture_name.h"
#include "verify/trace/program/presets.h"

namespace svdag {

namespace {

std::vector<double> numbers(const std::string& name, const std::string& text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    double value = 0;
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc() || !std::isfinite(value) || (read.ptr != end && *read.ptr != ','))
      fail_usage(name + ": \"" + text + "\" is not finite numbers with commas between them");
    values.push_back(value);
    if (read.ptr == end) return values;
    at = read.ptr + 1;
  }
}

uint32_t count(const std::string& name, const std::string& text, uint32_t least, uint32_t most) {
  uint32_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || value < least ||
      value > most)
    fail_usage(name + ": \"" + text + "\" is not a number from " + std::to_string(least) + " to " +
               std::to_string(most));
  return value;
}

double number(const std::string& name, const std::string& text, double most) {
  const std::vector<double> values = numbers(name, text);
  if (values.size() != 1 || !(values[0] >= 0 && values[0] <= most))
    fail_usage(name + ": \"" + text + "\" is not a number of 0 or more that makes sense here");
  return values[0];
}

void set_size(const std::string& text, TraceOptions* options) {
  const size_t cross = text.find('x');
  if (cross == std::string::npos) fail_usage("--size: \"" + text + "\" is not WIDTHxHEIGHT");
  options->width = count("--size", text.substr(0, cross), 1, 16384);
  options->height = count("--size", text.substr(cross + 1), 1, 16384);
}

void set_flag(const std::string& name, TraceOptions* options) {
  if (name == "--compare")
    options->compare = true;
  else if (name == "--help")
    options->help = true;
  else if (name == "--version")
    options->version = true;
  else if (name == "--no-beams")
    options->beams = false;
}

// "x, y or z"
std::string any_of(const std::vector<std::string>& choices) {
  std::string text = choices[0];
  for (size_t i = 1; i < choices.size(); ++i)
    text += (i + 1 < choices.size() ? ", " : " or ") + choices[i];
  return text;
}

// `name`: the last of the option's names; `value`: one of its choices, if it has any.
void set_option(const std::string& name, const std::string& value, TraceOptions* options) {
  if (name == "--device") {
    options->device = value;
  } else if (name == "--size") {
    set_size(value, options);
  } else if (name == "--preset") {
    options->preset = value;
  } else if (name == "--camera") {
    options->camera = numbers(name, value);
  } else if (name == "--light") {
    options->light = numbers(name, value);
  } else if (name == "--up") {
    options->up = value[0] - 'x';
  } else if (name == "--samples") {
    options->samples = count(name, value, 1, 4096);
  } else if (name == "--rounds") {
    options->rounds = count(name, value, 1, 1000);
  } else if (name == "--threads") {
    options->threads = count(name, value, 1, 1024);
  } else if (name == "--reach") {
    options->reach = number(name, value, 1e100);
  } else if (name == "--cone") {
    options->cone = number(name, value, 44);
  } else if (name == "--dump") {
    options->dump = value;
  } else if (name == "--picture") {
    refuse_other_pictures(value, ".ppm",
                          "pictures are PPM: choose a name in .ppm (svdag-verify render: PNG)");
    options->picture = value;
  }
}

Vec3 in_voxels(const double* point, const Header& header) {
  Vec3 v;
  for (int a = 0; a < 3; ++a) v[a] = (point[a] - header.corner[a]) / header.voxel_size;
  return v;
}

Camera make_camera(const TraceOptions& options, const PlainFile& file, const VoxelBounds& box) {
  const double aspect = double(options.width) / options.height;
  const std::vector<double>& c = options.camera;
  if (c.empty())
    return preset_camera(options.preset, file.view, box, options.up, Camera::kDefaultFov, aspect);
  if (c.size() != 6 && c.size() != 7)
    fail_usage("--camera: give px,py,pz,tx,ty,tz or px,py,pz,tx,ty,tz,fov");
  const double fov = c.size() == 7 ? c[6] : Camera::kDefaultFov;
  const Vec3 position = in_voxels(c.data(), file.header());
  const Vec3 target = in_voxels(c.data() + 3, file.header());
  const double far = length(target - position);
  if (!(fov >= 0.1 && fov <= 179))
    fail_usage("--camera: the angle of view is not 0.1 to 179 degrees");
  if (!(far > 0)) fail_usage("--camera: position and target are one point");
  if (!(far < 1e100 && length(position) < 1e100))
    fail_usage("--camera: position and target are more than 10^100 voxels away");
  return look_at(position, target, options.up, fov, aspect);
}

// An option, with its value if that is in the same word: --size=4x4, -j2.
struct Word {
  explicit Word(const std::string& word) {
    const bool is_long = word.starts_with("--");
    const size_t end = is_long ? word.find('=') : std::min<size_t>(2, word.size());
    name = word.substr(0, end);
    if (end < word.size()) value = word.substr(is_long ? end + 1 : end);
  }

  std::string name;
  std::optional<std::string> value;
};

const ManualOption& option_of(const Manual& manual, const std::string& name) {
  std::vector<std::string> names;
  for (const ManualOption& option : manual.options) {
    if (std::ranges::find(option.names, name) != option.names.end()) return option;
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  const CommandWords known{"", std::move(names)};
  const std::string unknown =
      explain_unknown(manual.command, std::span(&known, 1), std::span(&name, 1));
  fail_usage(unknown.empty()
                 ? "\"" + name + "\" is not an option; see " + manual.command + " --help"
                 : unknown);
}

std::string value_of(const ManualOption& option, const Word& word) {
  if (!word.value) fail_usage(word.name + ": needs a value (--help lists the options)");
  if (word.value->empty()) fail_usage(word.name + ": the value is empty");
  if (!option.choices.empty() &&
      std::ranges::find(option.choices, *word.value) == option.choices.end())
    fail_usage(word.name + ": \"" + *word.value + "\" is not " + any_of(option.choices));
  return *word.value;
}

}  // namespace

TraceOptions parse_trace_options(int argc, char** argv) {
  const Manual manual = trace_manual();
  TraceOptions options;
  std::set<std::string> given;
  bool only_files = false;  // behind "--"
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    if (only_files || text.size() < 2 || text[0] != '-') {
      if (!options.file.empty()) fail_usage(text + ": only one FILE can be traced");
      options.file = text;
      continue;
    }
    if (text == kManualTable || text == "--") {
      (text == "--" ? only_files : options.table) = true;
      continue;
    }
    Word word(text);
    const ManualOption& option = option_of(manual, word.name);
    const std::string& name = option.names.back();
    if (!given.insert(name).second) fail_usage(word.name + ": is given twice");
    if (option.value.empty()) {
      if (word.value) fail_usage(word.name + ": takes no value");
      set_flag(name, &options);
      continue;
    }
    if (!word.value && i + 1 < argc) word.value = argv[++i];
    set_option(name, value_of(option, word), &options);
  }
  if (options.file.empty() && !options.help && !options.version && !options.table)
    fail_usage("give the .svdag to trace (--help lists the options)");
  return options;
}

Workload make_workload(const TraceOptions& options, const PlainFile& file) {
  if (file.view.empty()) fail_usage(options.file + ": has no voxel to look at");
  const VoxelBounds box = occupied_bounds(file.view);
  Workload work{{make_camera(options, file, box), options.width, options.height}, {}, {}};
  const double diagonal = length(box.max - box.min);
  work.light.centre = (box.min + box.max) * 0.5;
  const bool inside = options.camera.empty() && options.preset == "inside";
  work.light.centre[options.up] +=
      (inside ? 0.4 : 1.5) * (box.max[options.up] - box.min[options.up]);
  work.light.radius = 0.02 * diagonal;
  if (!options.light.empty()) {
    if (options.light.size() != 3 && options.light.size() != 4)
      fail_usage("--light: give x,y,z or x,y,z,radius");
    work.light = {in_voxels(options.light.data(), file.header()),
                  options.light.size() == 4 ? options.light[3] / file.header().voxel_size : 0};
    const double radius = work.light.radius;
    if (!(length(work.light.centre) < 1e100) || !(radius >= 0 && radius < 1e100))
      fail_usage("--light: the light must be at a finite place, with a radius of 0 or more");
  }
  work.secondary.samples = options.samples;
  if (options.reach > 0) work.secondary.reach = options.reach / file.header().voxel_size;
  work.secondary.cut.spread = 2 * std::tan(options.cone * 3.14159265358979323846 / 180);
  work.beams = options.beams;
  work.rounds = options.rounds;
  work.threads = options.threads;
  return work;
}

}  // namespace svdag
