#include "verify/trace/program/plain_file.h"

#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "io/dag/colours/colours_check.h"
#include "io/dag/compact/compact_check.h"
#include "io/dag/layers/root_views.h"
#include "io/dag/pack/pack_format.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/file/input_watch.h"

namespace svdag {
namespace {

constexpr size_t kRootWords = sizeof(RootViews::Line) / sizeof(uint64_t);

void require(bool condition, const std::string& path, const char* sentence) {
  if (!condition) fail_input(path, std::string("damaged file: ") + sentence);
}

// Checked first, because the other fields have no meaning in files of another format.
void check_magic(const File& file, uint64_t size) {
  unsigned char magic[sizeof kMagic];
  if (size < sizeof magic) fail_input(file.path(), "is not a .svdag (it is too short)");
  file.read_at(0, std::as_writable_bytes(std::span(magic)));
  if (std::memcmp(magic, kPackedMagic, sizeof magic) == 0)
    fail_input(file.path(), "is packed: trace the result of svdag unpack");
  if (std::memcmp(magic, kMagic, sizeof magic) != 0)
    fail_input(file.path(),
               "is not a .svdag (its first bytes are not \\x89SVDAG): svdag build makes one of a "
               "scene");
}

// Checks the size in the header before allocating the memory.
std::vector<uint64_t> read_whole(const std::string& path, uint64_t max_bytes) {
  const File file = File::open_read(path);
  InputWatch inputs;
  inputs.add(file);
  const uint64_t size = file.size();
  check_magic(file, size);
  require(size >= sizeof(Header), path, "it ends within its header");
  Header header;
  file.read_at(0, std::as_writable_bytes(std::span(&header, 1)));
  require(header.file_bytes == size, path, "its size differs from the size in its header");
  if (size > max_bytes)
    throw Error(ExitCode::kMemory,
                "does not fit in memory: use svdag-verify render, which maps the file", path);
  std::vector<uint64_t> words((size + 7) / 8 + kRootWords);
  file.read_at(0, std::as_writable_bytes(std::span(words)).first(size));
  inputs.check();
  return words;
}

void check_header(const Header& h, const std::string& path) {
  if (h.version < 1 || h.version > kMaxVersion)
    fail_input(path, "has format version " + std::to_string(h.version) +
                         ", this program reads versions 1 to " + std::to_string(kMaxVersion));
  require(h.layout <= 1 && h.layer_kind < std::size(kLayerKindNames) &&
              h.version == version_of(Layout(h.layout), LayerKind(h.layer_kind), has_colours(h)),
          path, "impossible layout");
  require(h.header_bytes == sizeof(Header), path, "wrong header size");
  require(h.levels >= 3 && h.levels <= kMaxSections + 1, path,
          "the number of levels is not 3 to 20");
  require(h.section_count == h.levels - 1, path, "wrong number of sections");
  require(std::isnormal(h.voxel_size) && h.voxel_size > 0, path, "impossible voxel size");
  for (const double corner : h.corner)
    require(std::isfinite(corner), path, "impossible grid corner");
  for (uint32_t level = 0; level < h.section_count; ++level) {
    const Section& s = h.sections[level];
    require(s.offset % kSectionAlignment == 0 && s.offset >= sizeof(Header) &&
                s.offset <= h.file_bytes && s.bytes <= h.file_bytes - s.offset,
            path, "a section is not inside the file");
    const bool bricks = level + 1 == h.section_count;
    require(s.bytes % (bricks ? 8 : 4) == 0 && s.bytes / (bricks ? 8 : 4) <= kMaxWords, path,
            "impossible section size");
    require(!bricks || s.nodes == s.bytes / 8, path, "impossible number of bricks");
    require((s.bytes == 0) == (h.sections[h.section_count - 1].bytes == 0), path, "an empty level");
  }
  require(h.layer_count <= kMaxLayers && h.has_union <= 1 && h.layers_offset <= h.file_bytes &&
              h.layers_bytes <= h.file_bytes - h.layers_offset,
          path, "impossible layers");
  const auto is_inside = [&](uint64_t offset, uint64_t bytes, uint64_t unit) {
    return offset % kSectionAlignment == 0 && offset >= sizeof(Header) && offset <= h.file_bytes &&
           bytes <= h.file_bytes - offset && bytes % unit == 0;
  };
  require(!has_colours(h) ||
              (h.colour_level <= h.levels && is_inside(h.chunks_offset, h.chunks_bytes, 4) &&
               is_inside(h.directory_offset, h.directory_bytes, sizeof(ColourEntry))),
          path, "impossible colours");
}

void check_bricks(const DagView& view, const std::string& path) {
  for (uint64_t i = 0; i < view.brick_count; ++i)
    require(view.bricks[i] != 0, path, "an empty brick");
}

// From the deepest inner level up: each child pointer must be the index of a brick, or of the first
// word of a node of the level below, as found in the previous iteration.
void check_pointers(const Header& header, const DagView& view, const std::string& path) {
  require(has_possible_roots(header), path, "wrong number of roots");
  std::vector<bool> below;
  for (uint32_t level = view.brick_level(); level-- > 0;) {
    const uint32_t* words = view.words[level];
    const uint64_t count = view.index_end[level];
    const bool above_bricks = level + 1 == view.brick_level();
    std::vector<bool> starts(count);
    uint64_t nodes = 0;
    for (uint64_t at = 0; at < count; ++nodes) {
      const uint32_t mask = words[at];
      require(mask > 0 && mask < 256, path, "a node has an impossible child mask");
      starts[at++] = true;
      for (int child = popcount8(mask); child > 0; --child, ++at) {
        require(at < count, path, "the last node of a level is cut off");
        const bool valid = above_bricks ? words[at] < view.brick_count
                                        : words[at] < below.size() && below[words[at]];
        require(valid, path, "a child pointer does not lead to a node");
      }
    }
    require(level > 0 || nodes == header.sections[0].nodes, path, "wrong number of roots");
    below.swap(starts);
  }
}

}  // namespace

PlainFile read_plain_file(const std::string& path, uint64_t max_bytes) {
  PlainFile file;
  file.words = read_whole(path, max_bytes);
  check_header(file.header(), path);
  if (Layout(file.header().layout) == Layout::kCompact) {
    if (const auto defect = CompactCheck(file.words.data()).run())
      require(false, path, defect->sentence);
  }
  if (const auto defect = colours_defect(file.words.data())) require(false, path, defect->sentence);
  file.view = dag_view(file.words.data());
  const auto* const table =
      reinterpret_cast<const std::byte*>(file.words.data()) + file.header().layers_offset;
  auto layers = decode_layers(file.header(), {table, size_t(file.header().layers_bytes)});
  require(layers.has_value(), path, "an impossible layer table");
  file.layers = std::move(*layers);
  if (file.view.layout == Layout::kPlain) {
    check_bricks(file.view, path);
    check_pointers(file.header(), file.view, path);
  }
  if (!file.layers.empty()) {
    const RootViews roots(file.view);
    file.index.emplace(file.view.levels, file.layers.layers.size(), [&](size_t layer) {
      return roots.of(file.view, file.layers.layers[layer].root);
    });
  }
  return file;
}

void show_layer(PlainFile* file, size_t layer) {
  const DagView all = dag_view(file->words.data());
  const RootViews roots(all);
  file->view = roots.of(all, file->layers.layers[layer].root);
  if (all.layout == Layout::kCompact && !file->view.empty()) {
    auto* const room = &*(file->words.end() - kRootWords);
    RootViews::copy_line(&file->view, reinterpret_cast<RootViews::Line*>(room));
  }
  file->index.emplace(all.levels, file->layers.layers.size(), [&](size_t other) {
    return other == layer ? file->view : roots.of(all, kNoRoot);
  });
}

}  // namespace svdag
