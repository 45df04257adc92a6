// Wavefront OBJ: polygons and groups, in one pass.
//
// Vertices have colours if the first one has (`v x y z r g b`, in sRGB by custom).
// A face may use the vertices that precede it, counted from 1, or backwards from -1. Texture
// coordinates and normals are skipped; free-form curves and surfaces, lines and points
// are counted. Unknown statements are an Error: what they define would be missing. Zero bytes may
// follow the last line (ZBrush), but not hide lines. A face
// belongs to the last `o`, to all names of the last `g` and to the last `usemtl`: it is selected if
// none of these is excluded and one of them is included.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "io/scene/polygons/mesh_writer.h"
#include "io/scene/readers/mtl.h"
#include "io/scene/readers/obj_plain.h"
#include "io/scene/readers/text_scan.h"

namespace svdag {
namespace {

// Statements that define no shape, or only its appearance.
constexpr std::array<std::string_view, 27> kSkipped = {
    "vt",       "vn",       "vw",   "s",   "mtllib", "vp",         "mg",        "lod",   "usemap",
    "maplib",   "bevel",    "t",    "deg", "bmat",   "step",       "cstype",    "parm",  "end",
    "c_interp", "d_interp", "hole", "con", "trim",   "shadow_obj", "trace_obj", "ctech", "stech"};
constexpr std::array<std::string_view, 2> kPointsAndLines = {"l", "p"};
constexpr std::array<std::string_view, 5> kFreeForm = {"curv", "curv2", "surf", "sp", "scrv"};
constexpr uint64_t kMaxZeros = 16;  // at the end of a file

// Where the zero bytes at the end of the file begin.
uint64_t end_of_text(const File& file) {
  std::array<char, kMaxZeros> tail;
  uint64_t end = file.size();
  const uint64_t from = end - std::min(end, kMaxZeros);
  file.read_at(from, std::as_writable_bytes(std::span(tail).first(size_t(end - from))));
  while (end > from && tail[size_t(end - 1 - from)] == '\0') --end;
  return end > from && tail[size_t(end - 1 - from)] == '\n' ? end : file.size();
}

class ObjReader {
 public:
  ObjReader(const File& file, const ReadOptions& options, MeshWriter* out)
      : options_(options),
        file_bytes_(file.size()),
        stream_(file, 0, end_of_text(file)),
        scanner_(&stream_, {'#', true}),
        out_(*out) {
    if (options.images != nullptr)
      materials_ = read_mtl(file, {options.budget, options.allow_outside, options.images});
    out_.begin(MeshWriter::Precision::kDouble, file.size());
  }

  LeftOut read() {
    choose();
    while (!scanner_.at_end()) {
      if (!read_plain_line()) read_line();
      scanner_.next_line();
    }
    return left_out_;
  }

 private:
  // Reads a vertex or a face in the usual form, or a line to skip; else returns false without
  // reading anything.
  bool read_plain_line() {
    const std::string_view text = scanner_.visible();
    const char* stop = nullptr;
    if (text.starts_with("v ") && options_.paints == nullptr) {
      Point p;
      stop = read_plain_vertex(text.substr(2), &p);
      if (stop != nullptr) out_.vertex(p);
    } else if (text.starts_with("f ") && wanted_) {
      PlainFace face;
      stop = read_plain_face(text.substr(2), out_.vertices(), &face);
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
    if (face.corners == 3) return out_.triangle(i[0], i[1], i[2]);
    for (size_t c = 0; c < face.corners; ++c) out_.corner(i[c]);
    out_.end_polygon();
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
      object_ = scanner_.rest_of_line();
      choose();
    } else if (statement == "usemtl") {
      material_ = scanner_.rest_of_line();
      choose();
    } else {
      count_skipped(statement);
    }
  }

  void count_skipped(std::string_view statement) {
    const auto is_in = [&](const auto& list) {
      return std::ranges::find(list, statement) != list.end();
    };
    if (is_in(kSkipped)) return;
    if (!is_in(kPointsAndLines) && !is_in(kFreeForm))
      scanner_.fail("has a statement \"" + std::string(statement.substr(0, 40)) +
                    "\", which svdag does not read");
    left_out_.add(is_in(kFreeForm) ? Omission::kFreeForm : Omission::kPointsOrLines);
  }

  // What follows x, y, z (a weight, colours) is skipped unless colours are wanted.
  void read_vertex() {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = scanner_.number();
    if (options_.paints == nullptr) return out_.vertex(p);
    std::array<double, 4> more;  // red, green and blue, after a weight if there are four
    size_t n = 0;
    while (n < more.size() && !scanner_.at_line_end()) more[n++] = scanner_.number();
    if (out_.vertices() == 0) {
      is_coloured_ = n >= 3;
      if (is_coloured_) out_.begin_coloured(MeshWriter::Precision::kDouble, file_bytes_);
    }
    if (!is_coloured_) return out_.vertex(p);
    VertexColour colour = {kWhite16, kWhite16, kWhite16};
    for (size_t c = 0; c < 3 && n >= 3; ++c) colour[c] = light16_of_srgb(more[n - 3 + c]);
    out_.vertex(p, colour);
  }

  void read_face() {
    if (!wanted_) return;
    while (!scanner_.at_line_end()) {
      out_.corner(vertex(scanner_.integer('/')));
      if (!scanner_.at_word_end()) skip_references();
    }
    out_.end_polygon();
  }

  // The "/2/3" of a corner "1/2/3".
  void skip_references() {
    scanner_.skip_while([](char c) { return (c >= '/' && c <= '9') || c == '-' || c == '+'; });
    if (!scanner_.at_word_end()) scanner_.fail("has a face corner that is not index/index/index");
  }

  uint64_t vertex(int64_t index) {
    const uint64_t count = out_.vertices();
    const uint64_t i = index < 0 ? count + uint64_t(index) : uint64_t(index) - 1;
    if (i >= count)
      scanner_.fail("has a face with vertex " + std::to_string(index) + ", but " +
                    std::to_string(count) + " vertices precede it");
    return i;
  }

  void read_groups() {
    groups_.clear();
    while (!scanner_.at_line_end()) groups_.emplace_back(scanner_.word());
    choose();
  }

  // Selects or skips the faces that follow, and names their mesh.
  void choose() {
    std::vector<std::string> names = groups_;
    if (!object_.empty() || names.empty()) names.push_back(object_);
    // Every name is tried, so that every pattern that matches is recorded.
    const NameFilter& filter = *options_.names;
    bool included = options_.file_included, excluded = false;
    const auto try_name = [&](PartKind kind, const std::string& name) {
      included |= filter.includes(kind, name);
      excluded |= filter.excludes(kind, name);
    };
    for (const std::string& name : names) try_name(PartKind::kObject, name);
    if (!material_.empty()) try_name(PartKind::kMaterial, material_);
    wanted_ = included && !excluded;
    const std::string& mesh = names.front();
    if (mesh != mesh_) out_.mesh(mesh);
    mesh_ = mesh;
    const auto material = materials_.by_name.find(material_);
    out_.material(material_, wanted_ && material != materials_.by_name.end()
                                 ? colour_of(material->second, options_.images)
                                 : std::nullopt);
  }

  const ReadOptions& options_;
  uint64_t file_bytes_;
  MtlMaterials materials_;
  ByteStream stream_;
  TextScanner scanner_;
  MeshWriter& out_;
  // What earlier lines define for later ones.
  std::string object_;
  std::vector<std::string> groups_;
  std::string mesh_, material_;
  bool wanted_ = true;
  bool is_coloured_ = false;  // vertices have colours
  LeftOut left_out_;
};

}  // namespace

LeftOut read_obj(const File& file, const ReadOptions& options, MeshWriter* out) {
  return ObjReader(file, options, out).read();
}

}  // namespace svdag
