// OFF, the Object File Format (Geomview): text with polygons.
//
// Colours, normals and texture coordinates follow in the line of a vertex or a face; all but
// colours are skipped. The binary form and dimensions other than three are rejected.
//
// A colour is three numbers of sRGB, or four with an alpha that is ignored: of 0 .. 255 if they are
// whole and one is beyond 1, else of 0 .. 1. The file does not tell which; by this rule "1 0 0" of
// a program that prints floats so is red. A single number is an index of a colour map elsewhere.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "io/scene/polygons/mesh_writer.h"
#include "io/values/text_scan.h"

namespace svdag {
namespace {

// A count of elements of at least `bytes` each (the last one may lack its line end).
uint64_t read_count(TextScanner& scanner, const char* things, uint64_t bytes) {
  scanner.at_end();
  const int64_t n = scanner.integer();
  if (n < 0 || uint64_t(n) > (scanner.remaining() + 1) / bytes)
    scanner.fail("promises " + std::to_string(n) + " " + things + ", more than its bytes can hold");
  return uint64_t(n);
}

class OffReader {
 public:
  // `coloured`: the colours of vertices are wanted, or if they have none those of faces.
  OffReader(const File& file, bool coloured, MeshWriter* out)
      : stream_(file), scanner_(&stream_, kSyntax), is_coloured_(coloured), out_(*out) {}

  LeftOut read() {
    read_keyword();
    const uint64_t vertices = read_count(scanner_, "vertices", 6);  // "0 0 0\n"
    const uint64_t faces = read_count(scanner_, "faces", 2);        // "0\n"
    scanner_.next_line();  // the number of edges is ignored
    if (is_coloured_ && has_vertex_colours_) {
      out_.begin_coloured(MeshWriter::Precision::kDouble, vertices);
    } else {
      out_.begin(MeshWriter::Precision::kDouble, vertices);
    }
    for (uint64_t i = 0; i < vertices; ++i) read_vertex();
    for (uint64_t i = 0; i < faces; ++i) read_face();
    return left_out_;
  }

 private:
  static constexpr TextScanner::Syntax kSyntax = {'#', false};
  static constexpr std::array<double, 3> kWhite = {1, 1, 1};

  // [ST][C][N]OFF, the letters in any order (MeshLab writes NCOFF); then the counts, in the next
  // line, in this one, or in this word (files of ModelNet: "OFF8 12 0").
  void read_keyword() {
    scanner_.at_end();
    std::string_view rest = scanner_.word();
    for (bool more = true; more;) {
      more = false;
      for (const std::string_view prefix : {"ST", "C", "N"}) {
        if (!rest.starts_with(prefix)) continue;
        rest.remove_prefix(prefix.size());
        has_vertex_colours_ |= prefix == "C";
        has_normals_ |= prefix == "N";
        more = true;
      }
    }
    if (rest.size() > 3 && rest.starts_with("OFF") && rest[3] >= '0' && rest[3] <= '9')
      return scanner_.skip_to(rest.data() + 3);
    if (rest == "4OFF" || rest == "nOFF" || rest == "4nOFF")
      scanner_.fail("is an OFF file of a dimension other than three, which svdag does not read");
    if (rest != "OFF") scanner_.fail("does not begin with \"OFF\"");
    if (scanner_.next_letter() == 'B')
      scanner_.fail("is a binary OFF file, which svdag does not read: convert it to text or PLY");
  }

  void read_vertex() {
    Point p;
    for (int a = 0; a < 3; ++a) {
      scanner_.at_end();
      p[a] = scanner_.number();
    }
    if (is_coloured_ && has_vertex_colours_) {
      std::array<double, 3> normal;
      if (has_normals_) scanner_.numbers(normal);
      const std::array<double, 3> c = read_colour().value_or(kWhite);
      out_.vertex(p, {light16_of_srgb(c[0]), light16_of_srgb(c[1]), light16_of_srgb(c[2])});
    } else {
      out_.vertex(p);
    }
    scanner_.next_line();
  }

  // Of 0 .. 1 and sRGB.
  std::optional<std::array<double, 3>> read_colour() {
    std::array<double, 3> colour;
    const size_t count = scanner_.numbers(colour);
    if (count == 1) left_out_.add(Omission::kColourIndices);
    if (count < colour.size()) return {};
    const bool is_whole =
        std::ranges::all_of(colour, [](double value) { return std::floor(value) == value; });
    if (is_whole && std::ranges::max(colour) > 1) {
      for (double& value : colour) value /= 255;
    }
    left_out_.add(Omission::kBrightColours, std::ranges::max(colour) > 1);
    return colour;
  }

  void read_face() {
    for (uint64_t corners = read_count(scanner_, "corners", 2); corners > 0; --corners) {
      scanner_.at_end();
      const int64_t index = scanner_.integer();
      if (index < 0 || uint64_t(index) >= out_.vertices())
        scanner_.fail("has a face with vertex " + std::to_string(index) + ", but there are " +
                      std::to_string(out_.vertices()) + " vertices");
      out_.corner(uint64_t(index));
    }
    if (is_coloured_ && !has_vertex_colours_) {
      std::optional<Colour> colour;
      if (const auto c = read_colour())
        colour = Colour{colour_code((*c)[0]), colour_code((*c)[1]), colour_code((*c)[2])};
      if (colour != colour_) out_.material("", colour);
      colour_ = colour;
    }
    out_.end_polygon();
    scanner_.next_line();
  }

  ByteStream stream_;
  TextScanner scanner_;
  bool is_coloured_, has_vertex_colours_ = false, has_normals_ = false;
  std::optional<Colour> colour_;  // of faces, that out_ has
  LeftOut left_out_;
  MeshWriter& out_;
};

}  // namespace

LeftOut read_off(const File& file, const ReadOptions& options, MeshWriter* out) {
  if (!options.wants("")) return {};
  return OffReader(file, options.paints != nullptr, out).read();
}

}  // namespace svdag
