#include "verify/report/embedded_viewer.h"

#include <sodium/crypto_hash_sha256.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "streaming/memory/memory_budget.h"
#include "verify/report/report_text.h"
#include "verify/view/folder.h"
#include "verify/view/tile_file.h"

namespace svdag {
namespace {

constexpr uint32_t kMaxColours = 65536;  // at most 256 KiB, before compression

// The tiles of a level as a JSON object of texts in base 64; nothing if it has more than
// `max_bytes`.
std::optional<std::string> tiles_json(const TileCutter& cutter, uint64_t max_bytes,
                                      Executor& executor) {
  const TileList list = list_tiles(cutter);
  if (list.cubes.size() > max_bytes / 64) return {};
  std::vector<std::string> tiles(list.cubes.size());
  executor.for_each(tiles.size(), [&](size_t, size_t i) {
    const std::string tile = tile_of_list(cutter, list, i + 1);
    tiles[i] = base64(std::as_bytes(std::span(tile)));
  });
  std::string text = "{";
  for (size_t i = 0; i < tiles.size(); ++i)
    text += (i == 0 ? "\"" : ",\n\"") + std::to_string(i + 1) + "\":\"" + tiles[i] + "\"";
  text += "}";
  return text.size() <= max_bytes ? std::optional(text) : std::nullopt;
}

// The colours of the root's tile, of the level that the page chooses.
std::string colours_text(const DagColours& colours, const TileCutter& cutter) {
  const auto found = colours_in_page(colours, 1, cutter.tile_levels(), 0, kMaxColours);
  if (!found) return {};
  const std::string packed = compressed(found->colours);
  return base64(std::as_bytes(std::span(packed)));
}

// Runs in the page.
constexpr const char* kStart = R"(
const json = (id) => JSON.parse(document.getElementById(id).textContent), tiles = json('tiles'), parent = document.getElementById('svdag');
async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const bytes = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
  return new Uint32Array(bytes, 0, bytes.byteLength >> 2);
}
parent.hidden = false;
if (!start(parent, {scene: json('scene'), tile: (id) => unpack(tiles[id]), colours: () => unpack(json('colours'))})) parent.hidden = true;
)";

}  // namespace

EmbeddedViewer embed_viewer(const DagFile& file, int up, uint64_t max_bytes, Executor& executor) {
  EmbeddedViewer viewer;
  if (file.view().empty()) return viewer;
  // The list of layers takes its share of the page, but leaves some to the tiles.
  const std::string scene = scene_json(file, TileCutter(file, 3), {up, 1, false});
  max_bytes = std::max(max_bytes - std::min<uint64_t>(max_bytes, scene.size()), max_bytes / 8);
  std::string tiles;
  // A level has about four times the bytes of the one above.
  for (uint32_t level = 3; level <= file.view().levels; ++level) {
    const auto finer = tiles_json(TileCutter(file, level), max_bytes, executor);
    if (!finer) break;
    viewer.level = level;
    tiles = *finer;
  }
  if (viewer.level == 0) return viewer;
  const std::string script = "'use strict';\n" + joined_scripts() + kStart;
  unsigned char hash[crypto_hash_sha256_BYTES];
  crypto_hash_sha256(hash, reinterpret_cast<const unsigned char*>(script.data()), script.size());
  viewer.script_hash = "'sha256-" + base64(std::as_bytes(std::span(hash))) + "'";
  for (const PageFile& page : page_files()) {
    if (page.name == "view.css") viewer.style = page.text;
  }
  const TileCutter cutter(file, viewer.level);
  MemoryBudget budget(memory_or_default(0));
  std::optional<DagColours> colours;
  if (file.has_colours()) colours.emplace(file, &budget);
  viewer.html =
      "<div class=\"viewer\" id=\"svdag\" hidden></div>\n"
      "<script type=\"application/json\" id=\"scene\">" +
      scene_json(file, cutter,
                 {up, 1, false, colours ? colours->view().level() : 0, kMaxColours, true}) +
      "</script>\n<script type=\"application/json\" id=\"tiles\">" + tiles + "</script>\n";
  if (colours)
    viewer.html += "<script type=\"application/json\" id=\"colours\">\"" +
                   colours_text(*colours, cutter) + "\"</script>\n";
  viewer.html += "<script>" + script + "</script>\n";
  return viewer;
}

}  // namespace svdag
