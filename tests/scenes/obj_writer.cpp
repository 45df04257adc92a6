#include "tests/scenes/obj_writer.h"

#include <array>
#include <set>

#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "tests/scenes/numbers.h"

namespace svdag::scenes {
namespace {

struct Paint {
  const char* part;
  const char* diffuse;  // red, green, blue, 0 .. 1, sRGB
};
constexpr Paint kPaints[] = {{"stone", "0.80 0.74 0.62"},      {"plaster", "0.86 0.62 0.42"},
                             {"floor", "0.58 0.55 0.52"},      {"tile", "0.70 0.66 0.60"},
                             {"roof", "0.72 0.32 0.22"},       {"red cloth", "0.70 0.13 0.16"},
                             {"blue cloth", "0.16 0.30 0.62"}, {"vase", "0.66 0.40 0.24"},
                             {"leaves", "0.26 0.52 0.20"},     {"ground", "0.40 0.46 0.36"}};

void append(AtomicFile* file, std::string* text, size_t most) {
  if (text->size() < most) return;
  file->append(std::as_bytes(std::span(*text)));
  text->clear();
}

}  // namespace

void write_obj(const Mesh& mesh, const PlyOptions& options, const std::string& path) {
  if (options.shuffle) fail_usage("--shuffle: an .obj keeps the order of its parts: write a .ply");
  constexpr size_t kLarge = size_t(1) << 20;
  const std::string stem = path.substr(0, path.size() - 4);
  AtomicFile file(path);
  std::string text = "mtllib " + stem.substr(stem.find_last_of('/') + 1) + ".mtl\n";
  for (uint64_t i = 0; i < mesh.vertices(); ++i, append(&file, &text, kLarge)) {
    const Point p = placed(mesh, options, i);
    text += "v " + format_double(p.x) + ' ' + format_double(p.y) + ' ' + format_double(p.z) + '\n';
  }
  std::string part;
  std::set<std::string> parts;
  for (uint64_t i = 0; i < mesh.faces(); ++i, append(&file, &text, kLarge)) {
    if (std::string now = mesh.part(i); now != part || i == 0) {
      part = std::move(now);
      parts.insert(part);
      text += "o " + part + "\nusemtl " + part + '\n';
    }
    const Face face = mesh.face(i);
    text += "f " + std::to_string(face[0] + 1) + ' ' + std::to_string(face[1] + 1) + ' ' +
            std::to_string(face[2] + 1) + '\n';
  }
  append(&file, &text, 1);
  AtomicFile materials(stem + ".mtl");
  for (const Paint& paint : kPaints) {
    if (parts.contains(paint.part))
      text += std::string("newmtl ") + paint.part + "\nKd " + paint.diffuse + '\n';
  }
  append(&materials, &text, 1);
  materials.commit();
  file.commit();
}

}  // namespace svdag::scenes
