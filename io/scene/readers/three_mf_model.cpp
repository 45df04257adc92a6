#include "io/scene/readers/three_mf_model.h"

#include <expat.h>

#include <charconv>
#include <cstring>
#include <exception>
#include <memory>

#include "io/values/decimal.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// The name without its prefix. Prefixes are not resolved: the elements that are read differ by name
// and parent.
std::string_view local_name(const char* name) {
  const char* colon = std::strrchr(name, ':');
  return colon == nullptr ? name : colon + 1;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

// Calls start(name, attributes) and end() for each element.
class XmlReader {
 public:
  virtual ~XmlReader() = default;

  void parse(const XmlSource& source, const std::string& where) {
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
        XML_ParserCreate(nullptr), XML_ParserFree);
    if (!parser) throw std::bad_alloc();
    parser_ = parser.get();
    where_ = where;
    // expat would get one from the system, which a limited child cannot; its time is limited
    // anyway.
    XML_SetHashSalt(parser_, 1);
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(parser_, on_start, on_end);
    XML_SetStartDoctypeDeclHandler(parser_, on_doctype);
    source([&](std::string_view piece, bool is_last) {
      const XML_Status status =
          XML_Parse(parser_, piece.data(), int(piece.size()), is_last ? XML_TRUE : XML_FALSE);
      if (error_) std::rethrow_exception(error_);
      if (status == XML_STATUS_OK) return;
      if (XML_GetErrorCode(parser_) == XML_ERROR_NO_MEMORY) throw std::bad_alloc();
      fail(XML_ErrorString(XML_GetErrorCode(parser_)));
    });
    parser_ = nullptr;
  }

 protected:
  virtual void start(std::string_view name) = 0;
  virtual void end() = 0;

  [[noreturn]] void fail(const std::string& why) const {
    fail_input(where_, why + " (line " + std::to_string(XML_GetCurrentLineNumber(parser_)) + ")");
  }
  // Of the current element; null if there is none.
  const char* attribute(std::string_view name) const {
    for (const char** at = attributes_; at[0] != nullptr; at += 2) {
      if (local_name(at[0]) == name) return at[1];
    }
    return nullptr;
  }
  const char* required(std::string_view name) const {
    const char* value = attribute(name);
    if (value == nullptr) fail("an element lacks the attribute " + std::string(name));
    return value;
  }
  uint32_t number_of(const char* text) const {
    std::string_view word = text;
    while (!word.empty() && is_blank(word.front())) word.remove_prefix(1);
    while (!word.empty() && is_blank(word.back())) word.remove_suffix(1);
    uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || word.empty())
      fail("has \"" + std::string(word.substr(0, 40)) + "\" where a whole number should be");
    return value;
  }
  // Reads a number from `text` on; returns the end of the number and the blanks behind it.
  const char* read_double(const char* text, double* value) const {
    while (is_blank(*text)) ++text;
    const char* first = *text == '+' && text[1] != '-' ? text + 1 : text;
    const auto [end, error] = parse_decimal(first, first + std::strlen(first), *value);
    if (error != std::errc() || (*end != 0 && !is_blank(*end)))
      fail("has \"" + std::string(text).substr(0, 40) + "\" where a number should be");
    const char* rest = end;
    while (is_blank(*rest)) ++rest;
    return rest;
  }
  double double_of(const char* text) const {
    double value = 0;
    if (*read_double(text, &value) != 0)
      fail("has \"" + std::string(text).substr(0, 40) + "\" where a number should be");
    return value;
  }

 private:
  // An exception must not pass through expat.
  template <class Call>
  static void guarded(void* self, const Call& call) {
    auto& reader = *static_cast<XmlReader*>(self);
    if (reader.error_) return;
    try {
      call(reader);
    } catch (...) {
      reader.error_ = std::current_exception();
      XML_StopParser(reader.parser_, XML_FALSE);
    }
  }
  static void on_start(void* self, const char* name, const char** attributes) {
    guarded(self, [&](XmlReader& reader) {
      reader.attributes_ = attributes;
      reader.start(local_name(name));
    });
  }
  static void on_end(void* self, const char*) {
    guarded(self, [&](XmlReader& reader) { reader.end(); });
  }
  // No 3MF file has one; its entities could expand without limit.
  static void on_doctype(void* self, const char*, const char*, const char*, int) {
    guarded(self,
            [&](XmlReader& reader) { reader.fail("has a document type, which 3MF forbids"); });
  }

  XML_Parser parser_ = nullptr;
  std::string where_;
  const char** attributes_ = nullptr;
  std::exception_ptr error_;
};

std::string part_name(std::string_view path) {
  while (path.starts_with('/')) path.remove_prefix(1);
  return std::string(path);
}

enum class Element : uint8_t {
  kIgnored,
  kModel,
  kResources,
  kMaterials,
  kColours,
  kCoordinates,
  kObject,
  kMesh,
  kVertices,
  kTriangles,
  kBeamLattice,
  kBeams,
  kComponents,
  kBuild,
};

constexpr size_t kMaxXmlDepth = 1024;

class ModelReader : public XmlReader {
 public:
  explicit ModelReader(bool painted) : is_painted_(painted) {}

  ThreeMfModel model;

 protected:
  void start(std::string_view name) override {
    if (open_.size() >= kMaxXmlDepth) fail("has elements nested too deeply");
    Element element = Element::kIgnored;
    if (open_.empty()) {
      if (name != "model")
        fail("has <" + std::string(name.substr(0, 40)) + "> where <model> should be");
      start_model();
      element = Element::kModel;
    } else {
      element = start_in(open_.back(), name);
    }
    open_.push_back(element);
  }

  void end() override {
    const Element element = open_.back();
    open_.pop_back();
    if (element == Element::kMesh) end_mesh();
  }

 private:
  Element start_in(Element parent, std::string_view name) {
    switch (parent) {
      case Element::kModel:
        if (name == "resources") return Element::kResources;
        if (name == "build") return Element::kBuild;
        break;
      case Element::kResources:
        if (name == "object") return start_object();
        if (name == "basematerials") {
          materials_ = &model.materials[number_of(required("id"))];
          return Element::kMaterials;
        }
        if (!is_painted_) break;
        if (name == "colorgroup") return start_paint(Element::kColours);
        if (name == "texture2dgroup") return start_paint(Element::kCoordinates);
        if (name == "texture2d") add_image();
        break;
      case Element::kColours:
        if (name == "color") add_colour();
        break;
      case Element::kCoordinates:
        if (name == "tex2coord")
          paint_->corners.push_back({double_of(required("u")), double_of(required("v"))});
        break;
      case Element::kMaterials:
        if (name == "base") add_material();
        break;
      case Element::kObject:
        if (name == "mesh") return Element::kMesh;
        if (name == "components") return Element::kComponents;
        // Boolean operations, displaced and implicit surfaces.
        if (name != "metadatagroup") object_->left_out.add(Omission::kUnread);
        break;
      case Element::kMesh:
        if (name == "vertices") return Element::kVertices;
        if (name == "triangles") return Element::kTriangles;
        if (name == "beamlattice") return Element::kBeamLattice;
        if (name != "trianglesets") object_->left_out.add(Omission::kUnread);
        break;
      case Element::kBeamLattice:
        if (name == "beams") return Element::kBeams;
        break;
      case Element::kVertices:
        if (name == "vertex")
          object_->vertices.push_back(
              {double_of(required("x")), double_of(required("y")), double_of(required("z"))});
        break;
      case Element::kTriangles:
        if (name == "triangle") add_triangle();
        break;
      case Element::kBeams:
        if (name == "beam") object_->left_out.add(Omission::kBeams);
        break;
      case Element::kComponents:
        if (name == "component") object_->components.push_back(reference());
        break;
      case Element::kBuild:
        if (name == "item") model.items.push_back(reference());
        break;
      default:
        break;
    }
    return Element::kIgnored;
  }

  void start_model() {
    constexpr std::pair<std::string_view, double> kUnits[] = {
        {"micron", 1e-6}, {"millimeter", 0.001}, {"centimeter", 0.01},
        {"inch", 0.0254}, {"foot", 0.3048},      {"meter", 1}};
    const char* unit = attribute("unit");
    if (unit == nullptr) return;
    for (const auto& [name, metres] : kUnits) {
      if (name != unit) continue;
      model.unit_metres = metres;
      return;
    }
    fail("has an unknown unit, \"" + std::string(unit).substr(0, 40) + "\"");
  }

  Element start_object() {
    const uint32_t number = number_of(required("id"));
    const auto [at, is_new] = model.objects.try_emplace(number);
    if (!is_new) fail("has two objects with the number " + std::to_string(number));
    object_ = &at->second;
    if (const char* name = attribute("name")) object_->name = name;
    if (attribute("slicestackid") != nullptr) object_->left_out.add(Omission::kSlices);
    object_property_ = {};
    if (const char* group = attribute("pid")) {
      const char* index = attribute("pindex");
      object_property_ = {number_of(group), index == nullptr ? 0 : number_of(index)};
    }
    return Element::kObject;
  }

  void add_material() {
    ThreeMfMaterial material;
    if (const char* name = attribute("name")) material.name = name;
    if (const char* text = attribute("displaycolor")) material.colour = colour_of(text);
    materials_->push_back(std::move(material));
  }

  // "#RRGGBB" or "#RRGGBBAA".
  static std::optional<Colour> colour_of(std::string_view text) {
    return parse_colour(text.substr(0, 7));
  }

  Element start_paint(Element element) {
    paint_ = &model.paints[number_of(required("id"))];
    if (element == Element::kCoordinates) paint_->texture = number_of(required("texid"));
    return element;
  }

  void add_colour() {
    PaintedCorner corner;
    if (const auto colour = colour_of(required("color")))
      corner.colour = {light16_of_code(colour->r), light16_of_code(colour->g),
                       light16_of_code(colour->b)};
    paint_->corners.push_back(corner);
  }

  // Outside of an image whose style is "none" there is nothing; there its border goes on.
  Wrap wrap_of(const char* name) const {
    const std::string_view style = attribute(name) == nullptr ? "wrap" : attribute(name);
    return style == "mirror" ? Wrap::kMirror : style == "wrap" ? Wrap::kRepeat : Wrap::kClamp;
  }

  void add_image() {
    ThreeMfImage& image = model.images[number_of(required("id"))];
    image.part = part_name(required("path"));
    image.use.wrap_u = wrap_of("tilestyleu");
    image.use.wrap_v = wrap_of("tilestylev");
    const char* filter = attribute("filter");
    image.use.is_nearest = filter != nullptr && std::string_view(filter) == "nearest";
  }

  void add_triangle() {
    ThreeMfProperty property = object_property_;
    if (const char* group = attribute("pid")) property = {number_of(group), 0};
    if (const char* index = attribute("p1")) property.second = number_of(index);
    const auto [at, is_new] = index_of_.try_emplace(property, uint32_t(object_->properties.size()));
    if (is_new) object_->properties.push_back(property);
    object_->triangles.push_back(
        {number_of(required("v1")), number_of(required("v2")), number_of(required("v3"))});
    object_->property_of.push_back(at->second);
    if (!is_painted_) return;
    const auto corner = [&](const char* name) {
      return attribute(name) == nullptr ? property.second : number_of(attribute(name));
    };
    object_->other_corners.push_back({corner("p2"), corner("p3")});
  }

  void end_mesh() {
    for (const auto& triangle : object_->triangles) {
      for (const uint32_t corner : triangle) {
        if (corner >= object_->vertices.size())
          fail("has a triangle with vertex " + std::to_string(corner) + ", but " +
               std::to_string(object_->vertices.size()) + " vertices");
      }
    }
    index_of_.clear();
  }

  ThreeMfReference reference() const {
    ThreeMfReference reference;
    reference.object = number_of(required("objectid"));
    if (const char* path = attribute("path")) reference.part = part_name(path);
    if (const char* printable = attribute("printable"))
      reference.is_printable =
          std::strcmp(printable, "0") != 0 && std::strcmp(printable, "false") != 0;
    if (const char* text = attribute("transform")) {
      // Row by row, for row vectors.
      for (int i = 0; i < 12; ++i) text = read_double(text, &reference.to_parent.m[i % 3][i / 3]);
      if (*text != 0) fail("has a transform of more than 12 numbers");
    }
    return reference;
  }

  const bool is_painted_;
  std::vector<Element> open_;
  ThreeMfObject* object_ = nullptr;
  std::vector<ThreeMfMaterial>* materials_ = nullptr;
  ThreeMfPaint* paint_ = nullptr;
  ThreeMfProperty object_property_;
  std::map<ThreeMfProperty, uint32_t> index_of_;  // in properties of the object
};

class RelationshipReader : public XmlReader {
 public:
  std::string model;

 protected:
  void start(std::string_view name) override {
    if (name != "Relationship" || !model.empty()) return;
    const char* type = attribute("Type");
    const char* target = attribute("Target");
    if (type != nullptr && target != nullptr && std::string_view(type).ends_with("/3dmodel"))
      model = part_name(target);
  }
  void end() override {}
};

}  // namespace

ThreeMfModel parse_three_mf_model(const XmlSource& source, const std::string& where, bool painted) {
  ModelReader reader(painted);
  reader.parse(source, where);
  return std::move(reader.model);
}

std::string parse_three_mf_relationships(const XmlSource& source, const std::string& where) {
  RelationshipReader reader;
  reader.parse(source, where);
  return reader.model;
}

}  // namespace svdag
