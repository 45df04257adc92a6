// Wavefront OBJ: polygons and groups, in one pass if the positions fit in memory.
//
// A face may use the vertices that precede it, counted from 1, or backwards from -1. Texture
// coordinates and normals are skipped; free-form surfaces are rejected, because they
// would be missing from the scene. A face belongs to the last `o`, to all names of the last `g`
// and to the last `usemtl`: it is selected if none of these is excluded and one of them is
// included.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>

#include "io/scene/mesh/corners.h"
#include "io/scene/mesh/mesh_reader.h"
#include "io/scene/polygons/triangulate.h"
#include "io/scene/readers/mtl.h"
#include "io/scene/readers/obj_plain.h"
#include "io/scene/readers/text_scan.h"

namespace svdag {
namespace {

// Statements that define no surface, or only its appearance.
constexpr std::array<std::string_view, 27> kSkipped = {
    "vt",     "vn",     "s",     "l",        "p",          "mtllib",    "vp",    "mg",    "lod",
    "usemap", "maplib", "bevel", "c_interp", "d_interp",   "deg",       "bmat",  "step",  "cstype",
    "curv",   "curv2",  "parm",  "end",      "shadow_obj", "trace_obj", "ctech", "stech", "sp"};

// State of a pass over the lines: its position, and what earlier lines define for later ones.
struct ObjPlace {
  uint64_t offset = 0, line = 1;
  std::string object;
  std::vector<std::string> groups;
  std::string mesh, material;
  bool wanted = true;
};

// One pass over the lines, for positions in memory or spilled (io/scene/mesh/corners.h).
template <class Corners>
class ObjLines {
 public:
  ObjLines(const File& file, const ReadOptions& options,
           const std::map<std::string, MtlMaterial>& materials, const ObjPlace& from,
           Corners* positions, BatchWriter* writer)
      : options_(options),
        materials_(materials),
        stream_(file, from.offset),
        scanner_(&stream_, {'#', true}, from.line),
        at_(from),
        positions_(*positions),
        triangulator_(options.budget, file.path()),
        writer_(*writer) {}

  // Reads to the end of the file, or of the line at which the positions leave memory.
  ObjPlace read() {
    if (at_.offset == 0) choose();
    while (!positions_.spilled() && !scanner_.at_end()) {
      if (!read_plain_line()) read_line();
      scanner_.next_line();
    }
    at_.offset = scanner_.offset();
    at_.line = scanner_.line();
    return at_;
  }

 private:
  // Reads a vertex or a face in the usual form, or a line to skip; else returns false without
  // reading anything.
  bool read_plain_line() {
    const std::string_view text = scanner_.visible();
    const char* stop = nullptr;
    if (text.starts_with("v ")) {
      Point p;
      stop = read_plain_vertex(text.substr(2), &p);
      if (stop != nullptr) positions_.add(p);
    } else if (text.starts_with("f ") && at_.wanted) {
      PlainFace face;
      stop = read_plain_face(text.substr(2), positions_.size(), &face);
      if (stop != nullptr) add(face);
    } else if (text.starts_with("vt ") || text.starts_with("vn ")) {
      stop = text.data() + 2;
    }
    if (stop == nullptr) return false;
    scanner_.skip_to(stop);
    return true;
  }

  void add(const PlainFace& face) {
    const auto& i = face.index;
    if (face.corners == 3) {
      const Point a = positions_[i[0]], b = positions_[i[1]],
                  c = positions_[i[2]];  // in this order
      return writer_.add(a, b, c);
    }
    for (size_t c = 0; c < face.corners; ++c) triangulator_.corner(positions_[i[c]]);
    triangulator_.finish(writer_);
  }

  void read_line() {
    const std::string_view statement = scanner_.word();
    if (statement == "v") {
      read_vertex();
    } else if (statement == "f" || statement == "fo") {
      read_face();
    } else if (statement == "g") {
      read_groups();
    } else if (statement == "o") {
      at_.object = scanner_.rest_of_line();
      choose();
    } else if (statement == "usemtl") {
      at_.material = scanner_.rest_of_line();
      choose();
    } else if (std::find(kSkipped.begin(), kSkipped.end(), statement) == kSkipped.end()) {
      refuse(statement);
    }
  }

  [[noreturn]] void refuse(std::string_view statement) const {
    scanner_.fail("has a statement \"" + std::string(statement.substr(0, 40)) +
                  "\", which svdag does not read");
  }

  // What follows x, y, z (a weight, colours) is skipped.
  void read_vertex() {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = scanner_.number();
    positions_.add(p);
  }

  void read_face() {
    if (!at_.wanted) return;
    std::array<Point, 3> first;
    size_t corners = 0;
    for (; !scanner_.at_line_end(); ++corners) {
      const Point p = position(scanner_.integer('/'));
      if (!scanner_.at_word_end()) skip_references();
      if (corners < 3) {
        first[corners] = p;
        continue;
      }
      if (corners == 3)
        std::for_each(first.begin(), first.end(), [&](const Point& q) { triangulator_.corner(q); });
      triangulator_.corner(p);
    }
    if (corners == 3) writer_.add(first[0], first[1], first[2]);
    if (corners > 3) triangulator_.finish(writer_);
  }

  // The "/2/3" of a corner "1/2/3".
  void skip_references() {
    scanner_.skip_while([](char c) { return (c >= '/' && c <= '9') || c == '-' || c == '+'; });
    if (!scanner_.at_word_end()) scanner_.fail("has a face corner that is not index/index/index");
  }

  Point position(int64_t index) {
    const uint64_t count = positions_.size();
    const uint64_t i = index < 0 ? count + uint64_t(index) : uint64_t(index) - 1;
    if (i >= count)
      scanner_.fail("has a face with vertex " + std::to_string(index) + ", but " +
                    std::to_string(count) + " vertices precede it");
    return positions_[i];
  }

  void read_groups() {
    at_.groups.clear();
    while (!scanner_.at_line_end()) at_.groups.emplace_back(scanner_.word());
    choose();
  }

  // Selects or skips the faces that follow, and names their mesh.
  void choose() {
    std::vector<std::string> names = at_.groups;
    if (!at_.object.empty() || names.empty()) names.push_back(at_.object);
    // Every name is tried, so that every pattern that matches is recorded.
    const NameFilter& filter = *options_.names;
    bool included = options_.file_included, excluded = false;
    const auto try_name = [&](PartKind kind, const std::string& name) {
      included |= filter.includes(kind, name);
      excluded |= filter.excludes(kind, name);
    };
    for (const std::string& name : names) try_name(PartKind::kObject, name);
    if (!at_.material.empty()) try_name(PartKind::kMaterial, at_.material);
    at_.wanted = included && !excluded;
    const std::string& mesh = names.front();
    if (mesh != at_.mesh) writer_.mesh(mesh);
    at_.mesh = mesh;
    const auto material = materials_.find(at_.material);
    writer_.material(at_.material, at_.wanted && material != materials_.end()
                                       ? colour_of(material->second, options_.images)
                                       : std::nullopt);
  }

  const ReadOptions& options_;
  const std::map<std::string, MtlMaterial>& materials_;
  ByteStream stream_;
  TextScanner scanner_;
  ObjPlace at_;
  Corners& positions_;
  Triangulator triangulator_;
  BatchWriter& writer_;
};

}  // namespace

void read_obj(const File& file, const ReadOptions& options, const TriangleSink& sink) {
  Positions positions(options, Positions::Precision::kDouble, file.size());
  BatchWriter writer(sink);
  ObjPlace from;
  std::map<std::string, MtlMaterial> materials;
  if (options.images != nullptr) materials = read_mtl(file);
  read_corners(&positions, writer, [&](auto& corners, BatchWriter& out) {
    ObjLines lines(file, options, materials, from, &corners, &out);
    const ObjPlace end = lines.read();
    if constexpr (std::is_same_v<decltype(corners), Positions&>) from = end;
  });
  writer.flush();
}

}  // namespace svdag
