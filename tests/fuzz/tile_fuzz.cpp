// Arbitrary bytes as a tile, as the words of one with a repaired checksum, and as the path of a
// request: nothing, or a tile with one form.
#include <cstdlib>
#include <cstring>

#include "tests/fuzz/file_fuzz.h"
#include "tests/verify/raw_dag.h"
#include "verify/view/tile_file.h"

namespace svdag {
namespace {

void check(const std::optional<DagTile>& tile, std::span<const uint32_t> words) {
  if (!tile) return;
  const std::vector<uint32_t> again = words_of(*tile);
  if (!std::equal(again.begin(), again.end(), words.begin(), words.end())) std::abort();
}

void try_words(std::vector<uint32_t> words) {
  if (words.size() < 3) return;
  uint32_t hash = 0x811c9dc5;
  for (size_t i = 2; i < words.size(); ++i) hash = (hash ^ words[i]) * 0x01000193;
  words[0] = 0x31545653;
  words[1] = hash;
  check(tile_of_words(words), words);
}

void try_path(uint64_t path) {
  static const MemoryFile memory(
      RawFile(raw_dag(test_grid(7), {{1, 2, 3}, {9, 10, 11}, {127, 127, 0}})).bytes());
  static const DagFile file = DagFile::open(memory.file().path());
  static const TileCutter cutter(file, 7, 3);
  if (const auto tile = tile_of_path(cutter, path)) {
    const std::vector<uint32_t> words = words_of(*tile);
    if (!tile_of_words(words)) std::abort();
  }
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  if (const auto tile = decode_tile(std::as_bytes(std::span(data, size))))
    check(tile, words_of(*tile));
  std::vector<uint32_t> words(size / 4);
  if (!words.empty()) std::memcpy(words.data(), data, 4 * words.size());
  try_words(words);
  uint64_t path = 0;
  if (size > 0) std::memcpy(&path, data, std::min<size_t>(size, sizeof path));
  try_path(path);
  try_path(size < 1 ? 1 : path >> data[0] % 64);
  return 0;
}
