#include "io/formats/dags/hashdag_colours.h"

#include "io/formats/graph_window.h"

namespace svdag {
HashDagColours::HashDagColours(const File& file) : stream_(file) {
  const auto require = [&](bool condition) {
    if (!condition)
      fail_input(file.path(),
                 "is not a file of HashDAG colours: its size does not match its counts "
                 "(--no-colours ignores it)");
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
}

}  // namespace svdag
