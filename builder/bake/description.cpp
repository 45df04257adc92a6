#include "builder/bake/description.h"

#include <sstream>

#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"
#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr const char* kAlgorithm = "3";  // changes when nodes or bricks of any scene would

std::string hash_of(const File& file, ContentHash* hash) {
  ByteStream stream(file, hash->size());
  for (auto bytes = stream.peek(); !bytes.empty(); bytes = stream.peek()) {
    check_interrupt();
    hash->add(stream.offset(), bytes);
    stream.skip(bytes.size());
  }
  return to_hex(hash->digest());
}

// So that two texts never look the same, whatever is in them, and each stays on its line.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else {
      out += c;
    }
  }
  return out;
}

// One pattern with a space in it is not two patterns.
std::string list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) {
    const bool plain = !item.empty() && item.find_first_of(" \"\\\n") == std::string::npos;
    text += (text.empty() ? "" : " ") + (plain ? item : '"' + escaped(item) + '"');
  }
  return text;
}

std::string rule_and_size(Rule rule, int levels, double voxel_size) {
  return std::string("rule: ") + rule_name(rule) + '\n' +
         (voxel_size != 0 ? "voxel size: " + format_double(voxel_size)
                          : "resolution: " + std::to_string(uint64_t(1) << levels)) +
         '\n';
}

std::string coordinates(const Point& p) {
  std::string text;
  for (int a = 0; a < 3; ++a) text += ' ' + format_double(p[a]);
  return text;
}

// Every member is bound, so a new one must be described or, if it changes no byte, left out here.
void describe_options(const ContentOptions& options, std::ostream* out) {
  const auto& [layout, rule, levels, voxel_size, open_as_sheets, layers, with_union, cube, origin,
               bounds] = options;
  if (layout != Layout::kPlain) *out << "layout: " << layout_name(layout) << '\n';
  *out << "algorithm: " << kAlgorithm << '\n';
  *out << rule_and_size(rule, levels, voxel_size);
  if (open_as_sheets) *out << "open parts: surfaces\n";
  if (layers != LayerKind::kNone)
    *out << "layers: " << layer_kind_name(layers) << (with_union ? "" : ", without union") << '\n';
  if (cube) *out << "cube:" << coordinates(cube->min) << ' ' << format_double(cube->side) << '\n';
  if (origin) *out << "origin:" << coordinates(*origin) << '\n';
  if (bounds) *out << "bounds:" << coordinates(bounds->min) << coordinates(bounds->max) << '\n';
}

// The same. The files are described by their content, with those that allow_outside adds; colours
// follow from the layers.
void describe_scene(const SceneConfig& scene, std::ostream* out) {
  [[maybe_unused]] const auto& [paths, names, skip_invalid, sandbox, allow_unmatched, allow_outside,
                                transform, up, scale, hidden, time, frames, animation, cut_outs,
                                colours, paint, keep_images, only] = scene;
  *out << "included parts: " << list(names.include) << '\n';
  *out << "excluded parts: " << list(names.exclude) << '\n';
  if (const Affine to_world = scene.to_world(); to_world != Affine())
    *out << "transform: " << format_transform(to_world) << '\n';
  if (time || !frames.empty())
    *out << (time ? "time: " + format_double(*time) : "frames: " + frames.text())
         << " of animation " << escaped(animation) << '\n';
  if (hidden) *out << "hidden nodes: baked\n";
  if (!cut_outs) *out << "cut-outs: whole\n";
  if (!names.cut_out.empty()) *out << "cut-out materials: " << list(names.cut_out) << '\n';
  *out << "invalid triangles: " << (skip_invalid ? "dropped" : "refused") << '\n';
}

// The error is that of the file: the pass is the same.
void describe_pass(const ColourPassConfig& pass, std::ostream* out) {
  *out << "colours: algorithm " << kColourAlgorithm << ", level "
       << (pass.level ? std::to_string(*pass.level) : "by texels") << '\n';
}

void describe_files(const std::vector<SceneFile>& files, std::ostream* out) {
  for (const SceneFile& file : files)
    *out << "content of " << escaped(file.name()) << ": " << file.hash << '\n';
}

}  // namespace

std::vector<SceneFile> scene_files(const Scene& scene, ContentHashes hashed) {
  std::vector<SceneFile> files;
  scene.visit_files([&](const File& file) {
    files.push_back({file.path(), file.size(), hash_of(file, &hashed[file.path()])});
  });
  return files;
}

std::string describe(const BuildConfig& config, const std::vector<SceneFile>& files) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);  // a lack of memory must not shorten the text
  if (config.part)
    out << "part: cells " << config.part->begin << " to " << config.part->end << " of level "
        << config.part->level << '\n';
  if (config.ready != nullptr) return out.str() + config.ready->description;
  describe_options(config, &out);
  if (config.colours) {
    describe_pass(*config.colours, &out);
    out << "colour error: " << config.colours->error << '/' << kColourErrorUnit << '\n';
  }
  for (const LayerPalette::Line& line : config.palette.lines)
    out << "palette: " << colour_text(line.colour) << ' ' << escaped(line.pattern) << '\n';
  describe_scene(config.scene, &out);
  describe_files(files, &out);
  return out.str();
}

std::string describe_colours(const ColourPassConfig& pass, const SceneConfig& scene,
                             const std::string& content_hash, const std::vector<SceneFile>& files) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);
  out << "colours of: " << content_hash << '\n';
  describe_pass(pass, &out);
  describe_scene(scene, &out);
  describe_files(files, &out);
  return out.str();
}

SceneConfig described_scene(const BuildConfig& config) {
  SceneConfig scene = config.scene;
  if (config.colours) scene.colours = scene.paint = true;
  return scene;
}

std::string hash_of_description(const std::string& description) {
  Hasher128 hasher;
  hasher.update(std::as_bytes(std::span(description)));
  return to_hex(hasher.digest());
}

bool describes(const std::string& description, Rule rule, const Grid& grid) {
  const bool box = grid.kind == Grid::Kind::kBox;
  return description.find('\n' + rule_and_size(rule, grid.levels, box ? 0 : grid.voxel_size)) !=
         std::string::npos;
}

bool is_of_this_algorithm(const std::string& description) {
  return description.starts_with("algorithm: " + std::string(kAlgorithm) + "\n");
}

const std::vector<SceneFile>& Description::files() {
  if (files_.empty()) {
    if (watch_.empty()) watch_files();
    std::vector<SceneFile> files = scene_files(scene_, std::move(*hashed_));
    check_files();
    files_ = std::move(files);
  }
  return files_;
}

std::string Description::text() {
  return describe(config_, config_.ready != nullptr ? std::vector<SceneFile>() : files());
}

std::optional<std::string> Description::text_if_unchanged() {
  if (changed_) return std::nullopt;
  try {
    return text();
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kOutput) throw;
    changed_ = true;
    return std::nullopt;
  }
}

std::string difference(const std::string& saved, const std::string& now) {
  std::istringstream a(saved), b(now);
  a.exceptions(std::ios::badbit);
  b.exceptions(std::ios::badbit);
  std::string old_line, new_line;
  for (;;) {
    const bool more_old = bool(std::getline(a, old_line));
    const bool more_new = bool(std::getline(b, new_line));
    if (!more_old && !more_new) return {};
    if (more_old && more_new && old_line == new_line) continue;
    const auto shown = [](bool more, const std::string& line) {
      return more ? "\"" + line + "\"" : std::string("nothing");
    };
    return shown(more_old, old_line) + " then, " + shown(more_new, new_line) + " now";
  }
}

}  // namespace svdag
