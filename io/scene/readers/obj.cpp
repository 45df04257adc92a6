// Wavefront OBJ: polygons and groups, in one pass.
//
// Vertices have colours if the first one has (`v x y z r g b`, in sRGB by custom).
// A face may use the vertices that precede it, counted from 1, or backwards from -1. Normals are
// skipped, and texture coordinates if no material is cut out (obj_cut_out.h) or coloured by a
// texture (obj_paint.h); free-form curves and surfaces, lines and points are counted. Unknown
// statements are an Error: what they define would be missing. Zero bytes may follow the last line
// (ZBrush), but not hide lines. A face belongs to the last `o`, to all names of the last `g` and to
// the last `usemtl`: it is selected if none of these is excluded and one of them is included.
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/scene/polygons/mesh_writer.h"
#include "io/scene/readers/mtl.h"
#include "io/scene/readers/obj_cut_out.h"
#include "io/scene/readers/obj_paint.h"
#include "io/scene/readers/obj_plain.h"
#include "io/values/text_scan.h"

namespace svdag {
namespace {

// Statements that define no shape, or only its appearance.
constexpr std::array<std::string_view, 25> kSkipped = {
    "vn",   "vw",  "s",    "vp",         "mg",        "lod",   "usemap", "maplib",   "bevel",
    "t",    "deg", "bmat", "step",       "cstype",    "parm",  "end",    "c_interp", "d_interp",
    "hole", "con", "trim", "shadow_obj", "trace_obj", "ctech", "stech"};
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

// The coordinates of `vt` statements, in reserved memory.
class TextureCoordinates {
 public:
  explicit TextureCoordinates(MemoryBudget* budget) : memory_(budget->reserve(0, kPurpose)) {}

  void add(const TexturePoint& p) {
    if (points_.size() == points_.capacity()) {
      const size_t old = points_.capacity(), grown = std::max<size_t>(1024, 2 * old);
      memory_.resize((old + grown) * sizeof p, kPurpose);  // both while they are moved
      points_.reserve(grown);
      memory_.resize(grown * sizeof p, kPurpose);
    }
    points_.push_back(p);
  }
  uint64_t size() const { return points_.size(); }
  const TexturePoint& operator[](uint64_t i) const { return points_[size_t(i)]; }

 private:
  static constexpr const char* kPurpose = "texture coordinates";

  MemoryBudget::Reservation memory_;
  std::vector<TexturePoint> points_;
};

constexpr TexturePoint kNowhere = {std::numeric_limits<double>::quiet_NaN(), 0};

// What a material needs texture coordinates for; null: nothing.
struct TexturedSurface {
  const ObjCutOut* cut = nullptr;
  const ObjPaint* paint = nullptr;

  bool empty() const { return cut == nullptr && paint == nullptr; }
  // In the texture that colours or, without colours, cuts: both have one set of coordinates.
  TexturePoint place(const TexturePoint& vt) const {
    if (paint != nullptr)
      return paint->use->place(vt.u, vt.v, paint->paint.image->width(),
                               paint->paint.image->height());
    return cut->use->place(vt.u, vt.v, cut->cut.image->width(), cut->cut.image->height());
  }
  bool operator==(const TexturedSurface&) const = default;
};

class ObjReader {
 public:
  ObjReader(const File& file, const ReadOptions& options, MeshWriter* out)
      : options_(options),
        file_(file),
        stream_(file, 0, end_of_text(file)),
        scanner_(&stream_, {'#', true}),
        texture_(options.budget),
        out_(*out) {
    if (options.images != nullptr || options.alpha != nullptr)
      materials_ = read_mtl(file, {options.budget, options.allow_outside, options.images});
    out_.begin(MeshWriter::Precision::kDouble, file.size());
    bool is_cut = false;
    for (const auto& [name, material] : materials_.by_name) {
      if (options.alpha != nullptr)
        is_cut |= cutting_texture(name, material, *options.names) != nullptr;
      is_textured_ |= options.paints != nullptr && material.texture;
    }
    is_textured_ |= is_cut;
    if (is_cut) out_.count_cut_outs();
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
    } else if (text.starts_with("f ") && wanted_ && surface_.empty()) {
      PlainFace face;
      stop = read_plain_face(text.substr(2), out_.vertices(), &face);
      if (stop != nullptr) add(face);
    } else if ((text.starts_with("vt ") && !is_textured_) || text.starts_with("vn ")) {
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
    } else if (statement == "vt") {
      if (is_textured_) read_texture_coordinate();
    } else if (statement == "mtllib") {
      if (options_.images == nullptr && options_.alpha == nullptr) return;
      if (const auto unread = unread_mtl(file_, scanner_.rest_of_line(), materials_))
        left_out_.add(*unread);
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
    const size_t n = scanner_.numbers(more);
    if (out_.vertices() == 0) {
      is_coloured_ = n >= 3;
      if (is_coloured_) out_.begin_coloured(MeshWriter::Precision::kDouble, file_.size());
    }
    if (!is_coloured_) return out_.vertex(p);
    VertexColour colour = kWhiteCorners[0];
    for (size_t c = 0; c < 3 && n >= 3; ++c) colour[c] = light16_of_srgb(more[n - 3 + c]);
    left_out_.add(Omission::kBrightColours,
                  n >= 3 && std::max({more[n - 3], more[n - 2], more[n - 1]}) > 1);
    out_.vertex(p, colour);
  }

  void read_texture_coordinate() {
    TexturePoint p{scanner_.number(), 0};
    if (!scanner_.at_line_end()) p.v = scanner_.number();
    texture_.add(p);
  }

  // Of a material with a texture: whole and plain if the face has no texture coordinates.
  void read_textured_face() {
    bool is_first = true, has_texture = false;
    while (!scanner_.at_line_end()) {
      const uint64_t index = vertex(scanner_.integer('/'));
      std::optional<TexturePoint> place;
      if (!scanner_.at_word_end()) {
        skip_slash();
        if (!scanner_.at_word_end() && scanner_.visible().front() != '/')
          place = texture_point(scanner_.integer('/'));
        if (!scanner_.at_word_end()) skip_references();
      }
      if (std::exchange(is_first, false)) {
        has_texture = place.has_value();
        if (!has_texture && surface_.cut != nullptr && !std::exchange(is_untextured_, true))
          left_out_.add(Omission::kCutOuts);
        draw_with(has_texture ? surface_ : TexturedSurface());
      }
      if (place.has_value() != has_texture && surface_.cut != nullptr)
        scanner_.fail("has a face with texture coordinates at some of its corners only");
      has_texture ? out_.corner(index, place.value_or(kNowhere)) : out_.corner(index);
    }
    out_.end_polygon();
  }

  void skip_slash() {
    bool skipped = false;
    scanner_.skip_while([&](char c) { return c == '/' && !std::exchange(skipped, true); });
  }

  // What decides no voxel may be broken.
  TexturePoint texture_point(int64_t index) {
    const uint64_t count = texture_.size();
    const uint64_t i = index < 0 ? count + uint64_t(index) : uint64_t(index) - 1;
    if (i >= count && surface_.cut == nullptr) return kNowhere;
    if (i >= count)
      scanner_.fail("has a face with texture coordinate " + std::to_string(index) + ", but " +
                    std::to_string(count) + " precede it");
    const TexturePoint p = surface_.place(texture_[i]);
    if (surface_.cut != nullptr && !is_placeable(p))
      scanner_.fail(
          "has a texture coordinate of a cut-out that is NaN, infinite or beyond 2^40 texels "
          "(--no-cutouts bakes materials whole)");
    return p;
  }

  void read_face() {
    if (!wanted_) return;
    if (!surface_.empty()) return read_textured_face();
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
    const bool is_known = wanted_ && material != materials_.by_name.end();
    out_.material(material_, is_known && options_.images != nullptr ? colour_of(material->second)
                                                                    : std::nullopt);
    surface_ = is_known ? surface_of(material->second) : TexturedSurface();
    if (surface_.empty()) draw_with({});
    is_untextured_ = false;
  }

  // Of all faces, or, if their points have colours of their own, of those without a texture.
  std::optional<Colour> colour_of(const MtlMaterial& material) const {
    return options_.paints != nullptr ? material.diffuse
                                      : svdag::colour_of(material, options_.images);
  }

  // Of material_.
  TexturedSurface surface_of(const MtlMaterial& material) {
    TexturedSurface surface;
    if (options_.alpha != nullptr) surface.cut = cut_of(material);
    if (options_.paints != nullptr) surface.paint = paint_of(material, surface.cut);
    return surface;
  }

  void draw_with(const TexturedSurface& surface) {
    if (surface == drawn_) return;
    drawn_ = surface;
    out_.cut_out(surface.cut == nullptr ? nullptr : &surface.cut->cut);
    out_.paint(surface.paint == nullptr ? nullptr : &surface.paint->paint);
  }

  // What cuts material_ out; null: it is whole.
  const ObjCutOut* cut_of(const MtlMaterial& material) {
    const auto [at, is_new] = cuts_.try_emplace(material_);
    std::optional<ObjCutOut>& cut = at->second;
    if (is_new) {
      cut = cut_out_of(material_, material, *options_.names, file_.path(), options_.alpha);
      if (cut && cut->cut.is_opaque()) cut.reset();
      if (!cut && material.dissolve < 1) left_out_.add(Omission::kCutOuts);
    }
    return cut ? &*cut : nullptr;
  }

  // The texture that colours material_; null: none.
  const ObjPaint* paint_of(const MtlMaterial& material, const ObjCutOut* cut) {
    const auto [at, is_new] = paints_.try_emplace(material_);
    if (is_new) at->second = svdag::paint_of(material, cut, options_.paints);
    return at->second ? &*at->second : nullptr;
  }

  const ReadOptions& options_;
  const File& file_;
  MtlMaterials materials_;
  ByteStream stream_;
  TextScanner scanner_;
  bool is_textured_ = false;  // a material of the .mtl files needs texture coordinates
  TextureCoordinates texture_;
  std::map<std::string, std::optional<ObjCutOut>> cuts_;   // by material; none: it is whole
  std::map<std::string, std::optional<ObjPaint>> paints_;  // by material; none: no texture
  TexturedSurface surface_, drawn_;                        // of material_; that out_ has
  bool is_untextured_ = false;  // a face since choose() lacks its texture coordinates
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
