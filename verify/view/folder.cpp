#include "verify/view/folder.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <map>
#include <unordered_map>

#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/file/system_call.h"
#include "streaming/process/interrupt.h"
#include "verify/view/tile_file.h"

namespace svdag {
namespace {

constexpr size_t kSample = 64;  // tiles of a level that are cut for an estimate

// Without fsync: a run that continues checks what is there.
void write_whole(const std::string& folder, const std::string& name, std::string_view text) {
  const std::string path = folder + "/" + name;
  File file = File::create_anonymous(folder_of(path), path, File::kOutputMode);
  file.write_at(0, std::as_bytes(std::span(text)));
  file.link_as(path);
}

void create_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) fail_call(ExitCode::kOutput, "cannot be created", path, error.value());
}

namespace fs = std::filesystem;

[[noreturn]] void fail_foreign(const fs::path& path) {
  fail_usage(path.string() + ": is not a file of this page: remove it, or choose another folder");
}

// The name of a tile's file.
uint64_t name_of(const TileList& list, size_t i) {
  return list.paths.empty() ? i + 1 : list.paths[i];
}

// Whether `name` is that of a tile: 1 .. count, or a path.
bool is_tile_name(const std::string& name, const TileList& list) {
  uint64_t id = 0;
  std::from_chars(name.data(), name.data() + name.size(), id);
  const bool is_one = list.paths.empty() ? id >= 1 && id <= list.cubes.size()
                                         : std::ranges::binary_search(list.paths, id);
  return is_one && name == std::to_string(id);
}

// Checks that a subfolder holds entries of this type that are named as tiles.
void check_names(const fs::path& folder, fs::file_type type, const TileList& list) {
  if (!fs::exists(folder)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.symlink_status().type() != type || !is_tile_name(entry.path().filename(), list))
      fail_foreign(entry.path());
  }
}

// Checks that the folder of an earlier run holds only files that this run writes as well.
void check_folder(const std::string& folder, const TileList& list) {
  std::map<std::string, std::string_view> pages;
  for (const PageFile& page : page_files()) pages.emplace(page.name, page.text);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name == "scene.json" || ((name == "tiles" || (name == "colours" && !list.paths.empty())) &&
                                 entry.symlink_status().type() == fs::file_type::directory))
      continue;
    const auto page = pages.find(name);
    if (page == pages.end() || entry.symlink_status().type() != fs::file_type::regular)
      fail_foreign(entry.path());
    const File file = File::open_read(entry.path());
    if (file.size() != page->second.size() || file.text() != page->second)
      fail_usage(entry.path().string() +
                 ": differs from the page that this program writes: remove it, or choose another "
                 "folder");
  }
  check_names(folder + "/tiles", fs::file_type::regular, list);
  check_names(folder + "/colours", fs::file_type::directory, list);
}

// Creates the folder and its scene.json; accepts one of an earlier run for the same scene.
void open_folder(const std::string& folder, const std::string& scene, const TileList& list) {
  const std::string scene_path = folder + "/scene.json";
  create_folder(folder);
  if (fs::exists(scene_path)) {
    const File file = File::open_read(scene_path);
    if (file.size() != scene.size() || file.text() != scene)
      fail_usage(folder + ": holds the page of another scene or level; choose another folder");
    check_folder(folder, list);
  } else if (!fs::is_empty(folder)) {
    fail_usage(folder + ": is not empty and not such a page; choose another folder");
  } else {
    write_whole(folder, "scene.json", scene);
  }
  create_folder(folder + "/tiles");
}

// The end of the level of cube `begin`.
size_t level_end(const TileList& list, size_t begin) {
  size_t end = begin;
  while (end < list.cubes.size() && list.cubes[end].level == list.cubes[begin].level) ++end;
  return end;
}

// The bytes of a tile that an earlier run has written; 0 without a valid one.
uint64_t valid_bytes(const std::string& path) {
  if (!fs::exists(path)) return 0;
  const std::string text = File::open_read(path).text();
  return decode_tile(std::as_bytes(std::span(text))) ? text.size() : 0;
}

std::string key_of(const TileCube& cube) {
  std::string key;
  for (const auto& node : cube.nodes) key.append(reinterpret_cast<const char*>(&node), sizeof node);
  return key;
}

}  // namespace

TileList list_tiles(const TileCutter& cutter, bool by_path) {
  TileList list;
  const auto add = [&](TileCube cube, uint64_t path) {
    list.cubes.push_back(std::move(cube));
    if (by_path) list.paths.push_back(path);
    return by_path ? path : list.cubes.size();
  };
  if (TileCube root = cutter.root(); !root.nodes.empty()) add(std::move(root), 1);
  std::unordered_map<std::string, uint64_t> numbers;  // of the level below that of cube i
  for (size_t i = 0; i < list.cubes.size(); ++i) {
    check_interrupt();
    if (i > 0 && list.cubes[i].level != list.cubes[i - 1].level) numbers.clear();
    list.finer.emplace_back();
    if (!cutter.has_finer(list.cubes[i])) continue;
    for (unsigned c = 0; c < 8; ++c) {
      TileCube octant = cutter.octant(list.cubes[i], c);
      if (octant.nodes.empty() || cutter.is_full(octant)) continue;
      if (by_path) {
        list.finer[i][c] = add(std::move(octant), list.paths[i] << 3 | c);
        continue;
      }
      const auto [at, is_new] = numbers.emplace(key_of(octant), list.cubes.size() + 1);
      if (is_new) add(std::move(octant), 0);
      list.finer[i][c] = at->second;
    }
  }
  return list;
}

std::string tile_of_list(const TileCutter& cutter, const TileList& list, uint64_t id) {
  DagTile tile = cutter.cut(list.cubes[id - 1]);
  tile.finer = list.finer[id - 1];
  return encode_tile(tile);
}

uint64_t estimate_bytes(const TileCutter& cutter, const TileList& list, const DagColours* colours,
                        Executor& executor) {
  double bytes = 0;
  for (size_t begin = 0, end = 0; begin < list.cubes.size(); begin = end) {
    end = level_end(list, begin);
    const size_t count = end - begin, sample = std::min(count, kSample);
    std::atomic<uint64_t> sampled = 0;
    executor.for_each(sample, [&](size_t, size_t i) {
      check_interrupt();
      const size_t tile = begin + (2 * i + 1) * count / (2 * sample);
      sampled += tile_of_list(cutter, list, tile + 1).size();
      if (colours == nullptr) return;
      if (const auto own = colours_in_page(*colours, list.paths[tile], cutter.tile_levels()))
        sampled += compressed(own->colours).size();
    });
    bytes += double(sampled) * double(count) / double(sample);
  }
  return uint64_t(bytes);
}

uint64_t write_folder(const std::string& folder, const DagFile& file, const TileCutter& cutter,
                      const TileList& list, const DagColours* colours, int up, Executor& executor,
                      Progress& progress) {
  SVDAG_ASSERT((colours == nullptr) == list.paths.empty());
  const uint32_t colour_level = colours != nullptr ? colours->view().level() : 0;
  open_folder(folder, scene_json(file, cutter, {up, 1, false, colour_level}), list);
  progress.phase("Tiles", list.cubes.size());
  std::atomic<uint64_t> bytes = 0;
  const auto write_tile = [&](size_t i) {
    const std::string name = "tiles/" + std::to_string(name_of(list, i));
    uint64_t size = valid_bytes(folder + "/" + name);
    if (size == 0) {
      const std::string text = tile_of_list(cutter, list, i + 1);
      write_whole(folder, name, text);
      size = text.size();
    }
    bytes += size;
  };
  std::vector<uint32_t> finest(colours != nullptr ? list.cubes.size() : 0);  // shown, up to here
  const auto write_colours = [&](size_t i) {
    const uint64_t path = list.paths[i];
    if (i > 0)
      finest[i] =
          finest[size_t(std::ranges::lower_bound(list.paths, path >> 3) - list.paths.begin())];
    const auto own = colours_in_page(*colours, path, cutter.tile_levels(), finest[i]);
    if (!own) return;
    finest[i] = own->level;
    const std::string of_tile = "colours/" + std::to_string(path);
    create_folder(folder + "/" + of_tile);
    const std::string text = compressed(own->colours);
    write_whole(folder, of_tile + "/" + std::to_string(own->level), text);
    bytes += text.size();
  };
  for (size_t begin = 0, end = 0; begin < list.cubes.size(); begin = end) {
    end = level_end(list, begin);
    executor.for_each(end - begin, [&](size_t, size_t i) {
      check_interrupt();
      write_tile(begin + i);
      if (colours != nullptr) write_colours(begin + i);
      progress.advance();
    });
  }
  for (const PageFile& page : page_files()) write_whole(folder, std::string(page.name), page.text);
  return bytes;
}

}  // namespace svdag
