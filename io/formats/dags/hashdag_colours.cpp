#include "io/formats/dags/hashdag_colours.h"

#include <cstdio>

#include "io/formats/graph_window.h"

namespace svdag {
namespace {

// `label`: 0xBBGGRR.
Layer layer_of(uint64_t label) {
  const Colour colour{uint8_t(label), uint8_t(label >> 8), uint8_t(label >> 16)};
  char name[8];
  std::snprintf(name, sizeof name, "#%02x%02x%02x", colour.r, colour.g, colour.b);
  return {name, colour};
}

}  // namespace

HashDagColours::HashDagColours(const File& file, LayerTable* layers)
    : stream_(file), numbers_(file.path(), layers, layer_of) {
  const auto require = [&](bool condition) {
    if (!condition)
      fail_input(file.path(),
                 "is not a file of HashDAG colours: its size does not match its counts "
                 "(--no-layers ignores it)");
  };
  require(stream_.remaining() >= 12);
  header_value<uint32_t>(&stream_);
  const uint64_t nodes = header_value<uint64_t>(&stream_);
  require(nodes <= stream_.remaining() / sizeof(uint64_t));
  stream_.skip(nodes * sizeof(uint64_t));
  require(stream_.remaining() >= 8);
  count_ = header_value<uint64_t>(&stream_);
  require(stream_.remaining() % sizeof(uint32_t) == 0 &&
          count_ == stream_.remaining() / sizeof(uint32_t));
  layers->kind = LayerKind::kMaterial;
}

}  // namespace svdag
