// OFF, the Object File Format (Geomview): text with polygons.
//
// Colours, normals and texture coordinates are what follows in the line of a vertex or a face;
// they are skipped. The binary form and dimensions other than three are refused by name.
#include <string>

#include "io/scene/mesh_reader.h"
#include "io/scene/positions.h"
#include "io/scene/text_scan.h"
#include "io/scene/triangulate.h"

namespace svdag {
namespace {

class OffReader {
 public:
  OffReader(const File& file, const ReadOptions& options, const TriangleSink& sink)
      : stream_(file),
        scanner_(&stream_, {'#', false}),
        positions_(options.budget, Positions::Precision::kDouble),
        triangulator_(options.budget),
        writer_(sink) {}

  void read() {
    read_keyword();
    const uint64_t vertices = count("vertices", 6);  // "0 0 0\n"
    const uint64_t faces = count("faces", 2);        // "0\n"
    scanner_.next_line();                            // the number of edges means nothing
    for (uint64_t i = 0; i < vertices; ++i) read_vertex();
    for (uint64_t i = 0; i < faces; ++i) read_face();
    writer_.flush();
  }

 private:
  // [ST][C][N]OFF, then the counts in the same line or in the next.
  void read_keyword() {
    scanner_.at_end();
    std::string_view rest = scanner_.word();
    for (const std::string_view prefix : {"ST", "C", "N"}) {
      if (rest.starts_with(prefix)) rest.remove_prefix(prefix.size());
    }
    if (rest == "4OFF" || rest == "nOFF" || rest == "4nOFF")
      scanner_.fail("is an OFF file of a dimension other than three, which svdag does not read");
    if (rest != "OFF") scanner_.fail("does not begin with \"OFF\"");
    if (scanner_.next_letter() == 'B')
      scanner_.fail("is a binary OFF file, which svdag does not read: convert it to text or PLY");
  }

  // A number of things that take at least `bytes` each (the last one may lack its line end).
  uint64_t count(const char* things, uint64_t bytes) {
    scanner_.at_end();
    const int64_t n = scanner_.integer();
    if (n < 0 || uint64_t(n) > (scanner_.remaining() + 1) / bytes)
      scanner_.fail("promises " + std::to_string(n) + " " + things +
                    ", more than its bytes can hold");
    return uint64_t(n);
  }

  void read_vertex() {
    Point p;
    for (int a = 0; a < 3; ++a) {
      scanner_.at_end();
      p[a] = scanner_.number();
    }
    positions_.add(p);
    scanner_.next_line();
  }

  void read_face() {
    for (uint64_t corners = count("corners", 2); corners > 0; --corners) {
      scanner_.at_end();
      const int64_t index = scanner_.integer();
      if (index < 0 || uint64_t(index) >= positions_.size())
        scanner_.fail("has a face with vertex " + std::to_string(index) + ", but there are " +
                      std::to_string(positions_.size()) + " vertices");
      triangulator_.corner(positions_[uint64_t(index)]);
    }
    triangulator_.finish(writer_);
    scanner_.next_line();
  }

  ByteStream stream_;
  TextScanner scanner_;
  Positions positions_;
  Triangulator triangulator_;
  BatchWriter writer_;
};

}  // namespace

void read_off(const File& file, const ReadOptions& options, const TriangleSink& sink) {
  if (options.wants("")) OffReader(file, options, sink).read();
}

}  // namespace svdag
