// The interface of all scene formats: triangles in world space, in batches.
//
// One function per format, one file per function. A reader passes vertices and polygons in the
// order of the file to a MeshWriter (io/scene/polygons/mesh_writer.h), which holds at most the
// vertex positions of one mesh (reserved in `budget`), never the faces; positions beyond their
// share of the memory go to a spill file if there is one (io/scene/mesh/positions.h). A reader
// checks every count against the remaining bytes before it allocates, and reports a damaged file as
// one Error (kBadInput).
// Readers pass non-finite coordinates on unchanged; io/scene/scene.cpp decides about them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/colour.h"
#include "io/scene/colours/paint.h"
#include "io/scene/cutouts/cut_out.h"
#include "io/scene/mesh/left_out.h"
#include "io/scene/mesh/name_filter.h"
#include "io/triangle.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// Consecutive triangles of one mesh; valid during the call only.
struct TriangleBatch {
  std::string_view mesh;              // glTF node or OBJ group, "" where the format has no names
  std::string_view material;          // "": none, or without a name
  std::optional<Colour> colour = {};  // of the material, if the format tells
  std::string_view file = {};         // the name of the file, without its folder; set by Scene
  std::string_view frame = {};        // the name of the time (--frames); set by Scene
  uint64_t first = 0;  // number, within the mesh, of the first triangle of this batch
  std::span<const Triangle> triangles;
  double quantisation = 0;  // world distance of the steps positions were stored in (Draco); 0: none
  bool undeformed = false;  // as stored, though a skin or morph targets deform the mesh (glTF)
  // Of a material with transparent points that are cut out: which, and where each triangle is in
  // its texture. Null and empty: the triangles are whole.
  const CutOut* cut = nullptr;
  std::span<const TextureCorners> texture = {};
  // What colours the points of the triangles, with `texture` and the colours of the corners. Null
  // and empty: they have the one colour of their material, or colours of points are not wanted.
  const Paint* paint = nullptr;
  std::span<const CornerColours> corner_colours = {};
};

// The name of the part of this kind that a batch belongs to.
inline std::string_view part_name(const TriangleBatch& batch, PartKind kind) {
  switch (kind) {
    case PartKind::kObject:
      return batch.mesh;
    case PartKind::kMaterial:
      return batch.material;
    case PartKind::kFile:
      return batch.file;
    case PartKind::kFrame:
      return batch.frame;
  }
  return "";
}

using TriangleSink = std::function<void(const TriangleBatch&)>;

class AlphaImages;
class LinearImages;
class SpillFile;

// Spill space for the vertex positions of a mesh that do not fit in memory. STL needs none.
struct SpillSpace {
  // Bytes of the budget that the reader takes for positions: at least 16 blocks of the file. With
  // blocks of b bytes a mesh may have share^2 / 8b bytes of positions (12 or 24 a vertex) at least.
  uint64_t share = 0;
  std::function<SpillFile*()> file;         // opened by the first call
  std::function<uint64_t()> stream_number;  // never used before in the file
  std::string unpack_folder = {};           // of decompressed files; empty: the temporary folder
};

// The folder of files of decompressed data.
std::string unpack_folder_of(const SpillSpace* spill);
// An anonymous file in it, with the path() of the compressed file.
File create_unpacked(const std::string& path, const SpillSpace* spill);

// The result of reading a mesh for its box only.
struct MeshBox {
  Box box;
  uint64_t triangles = 0;
};

// An animation of a file.
struct Animation {
  std::string name;      // may be empty
  double seconds = 0;    // of its last key
  uint64_t nodes = 0;    // that it moves
  uint64_t weights = 0;  // nodes whose weights of morph targets it sets
};

// A time of animations.
struct PoseTime {
  double seconds = 0;
  std::string animation = "all";  // its name, "#" and its number from 0, or "all"

  bool operator==(const PoseTime&) const = default;
};

struct ReadOptions {
  const NameFilter* names = nullptr;  // never null in a reader
  // The file's own name matched --include: its parts need not match again.
  bool file_included = false;
  MemoryBudget* budget = nullptr;  // never null in a reader
  // Null: a mesh whose positions exceed the budget is an Error (kMemory).
  const SpillSpace* spill = nullptr;
  // Not null: a reader may add triangles to this instead of passing them on, if all are finite.
  MeshBox* box_alone = nullptr;
  // Third-party decoders run in a limited child process (streaming/process/limited_child.h).
  bool sandbox = false;
  // Not null: the colours of materials are wanted, though they need further files; perhaps only
  // means, for which small images are enough.
  LinearImages* images = nullptr;
  bool allow_outside = false;      // read materials and textures outside the folder of an .obj file
  bool hidden = false;             // read nodes that the file hides
  const PoseTime* time = nullptr;  // null: the pose at rest
  // Not null: set to the length of a unit of the coordinates in metres, if the file states it.
  double* unit_metres = nullptr;
  // Not null: what is transparent of materials is cut out. It must outlive the triangles' CutOut.
  AlphaImages* alpha = nullptr;
  // Not null: colours of points are wanted; it is `images`. It must outlive the triangles' Paint.
  LinearImages* paints = nullptr;

  // Whether the object `name`, which has no material, is selected.
  bool wants(const std::string& name) const {
    // Both are called in any case: they record which patterns match.
    const bool included = names->includes(PartKind::kObject, name);
    return !names->excludes(PartKind::kObject, name) && (file_included || included);
  }
};

class MeshWriter;  // io/scene/polygons/mesh_writer.h

LeftOut read_ply(const File& file, const ReadOptions& options, MeshWriter* out);
LeftOut read_stl(const File& file, const ReadOptions& options, MeshWriter* out);
LeftOut read_obj(const File& file, const ReadOptions& options, MeshWriter* out);
LeftOut read_off(const File& file, const ReadOptions& options, MeshWriter* out);
LeftOut read_gltf(const File& file, const ReadOptions& options, MeshWriter* out);  // and GLB
LeftOut read_draco(const File& file, const ReadOptions& options, MeshWriter* out);
LeftOut read_openmesh(const File& file, const ReadOptions& options, MeshWriter* out);  // .om
LeftOut read_fbx(const File& file, const ReadOptions& options, MeshWriter* out);
LeftOut read_3mf(const File& file, const ReadOptions& options, MeshWriter* out);
// With Assimp.
LeftOut read_collada(const File& file, const ReadOptions& options, MeshWriter* out);
LeftOut read_3ds(const File& file, const ReadOptions& options, MeshWriter* out);

// Collects triangles and passes them on in batches of up to kBatch.
class BatchWriter {
 public:
  static constexpr size_t kBatch = 4096;

  explicit BatchWriter(const TriangleSink& sink)
      : sink_(sink), batch_(std::make_unique_for_overwrite<Triangle[]>(kFirst)) {}
  // Starts the next mesh: flushes, and counts triangles from 0 again.
  void mesh(std::string_view name, bool undeformed = false);
  // Of the triangles from here on: the name of their material, the quantisation step, and whether
  // they are given by the mirror image of a mesh, so that two corners must change places for the
  // outside to be outside.
  void material(std::string_view name, std::optional<Colour> colour = {});
  void quantisation(double step);
  void mirrored(bool mirrored);
  // Of the triangles from here on: what cuts them out, and what colours them; null: nothing does.
  // If either is set, the functions below add them.
  void cut_out(const CutOut* cut);
  void paint(const Paint* paint);
  void add_textured(const Triangle& t, const TextureCorners& texture,
                    const CornerColours& colours = kWhiteCorners) {
    texture_.push_back(texture);
    if (paint_ != nullptr) corner_colours_.push_back(colours);
    if (paint_ != nullptr && paint_->image && !std::ranges::all_of(texture, is_placeable))
      ++unplaced_;
    add(t.v[0], t.v[1], t.v[2]);
  }
  // Triangles so far with a corner that is nowhere in the texture that colours them.
  uint64_t unplaced() const { return unplaced_; }
  // Writes each corner to its place: a Triangle that is built first and then copied is read back in
  // pieces of another size than it was written in, which stalls on the store buffer.
  void add(const Point& a, const Point& b, const Point& c) {
    Triangle& t = batch_[size_];
    t.v[0] = a;
    t.v[1] = b;
    t.v[2] = c;
    if (++size_ == room_) make_room();
  }
  void flush();

 private:
  static constexpr size_t kFirst = 64;  // small scenes need few

  void make_room();

  const TriangleSink& sink_;
  std::string mesh_, material_;
  std::optional<Colour> colour_;
  uint64_t first_ = 0;
  double quantisation_ = 0;
  bool undeformed_ = false;
  bool mirrored_ = false;
  const CutOut* cut_ = nullptr;
  const Paint* paint_ = nullptr;
  std::vector<TextureCorners> texture_;        // of batch_, if it is cut or painted
  std::vector<CornerColours> corner_colours_;  // of batch_, if it is painted
  std::unique_ptr<Triangle[]> batch_;
  uint64_t unplaced_ = 0;
  size_t size_ = 0, room_ = kFirst;  // triangles in batch_, and its capacity
};

}  // namespace svdag
