// A scene: one or more files read as one triangle soup, any number of times, never held in memory.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/affine.h"
#include "io/dag/format.h"
#include "io/scene/colours/linear_images.h"
#include "io/scene/cutouts/alpha_images.h"
#include "io/scene/frame_range.h"
#include "io/scene/mesh/mesh_reader.h"
#include "streaming/file/content_hash.h"
#include "streaming/file/input_watch.h"

namespace svdag {

// The parts that are layers of this kind, which is not kNone.
constexpr PartKind part_of(LayerKind kind) {
  return PartKind(uint32_t(kind) - 1);  // the same order, after kNone
}

struct SceneConfig {
  std::vector<std::string> paths;  // at least one
  NameFilter names;                // --include, --exclude
  bool skip_invalid = false;       // drop triangles with NaN or infinity instead of failing
  bool sandbox = false;            // --sandbox: third-party decoders run in a limited child process
  bool allow_unmatched = false;    // --allow-empty: a pattern may match no name
  bool allow_outside = false;      // --allow-outside: .mtl files and textures of an .obj file
  Affine transform = {};           // --transform
  Affine up = {};                  // --up: after `transform`
  double scale = 1;                // --scale: after `up`
  bool hidden = false;             // --hidden: nodes that the file hides
  std::optional<double> time = {};  // --time
  FrameRange frames = {};           // --frames: the triangles at all these times; instead of time
  std::string animation = "all";    // --animation, as in PoseTime
  bool cut_outs = true;             // what is transparent of materials is cut out
  bool colours = false;             // of materials are read, and the files that hold them
  bool paint = false;               // with `colours`: those of points, too
  bool keep_images = false;         // for judges, with `paint`: LinearImage::encoded()
  // For judges: if given, only the triangles of the part of this kind and name.
  std::optional<std::pair<PartKind, std::string>> only = {};

  // From the coordinates of the files, transforms of glTF nodes included, to the world.
  Affine to_world() const { return compose(scaling(scale), compose(up, transform)); }
};

struct SceneCounts {
  uint64_t triangles = 0;     // passed to the sink
  double quantisation = 0;    // largest step that positions were stored in, in world units
  uint64_t invalid = 0;       // dropped: a coordinate was NaN or infinite
  uint64_t cut = 0;           // of materials of which transparent points are cut out
  uint64_t undeformed = 0;    // as stored, though a skin or morph targets deform their mesh
  LeftOut left_out;           // by the readers; of frames, by each
  std::vector<double> units;  // in metres, each once: those that files state
  std::vector<std::string> unmatched;      // "--include 'sky*'": with allow_unmatched
  std::vector<std::string> unread_images;  // "PATH: why": with colours
};

class Scene {
 public:
  // Opens nothing yet. `budget` and `spill` (io/scene/mesh/mesh_reader.h) must outlive the scene.
  Scene(SceneConfig config, MemoryBudget* budget, const SpillSpace* spill = nullptr);

  // Hashes the files as they are read from here on; `hashes` must outlive the scene.
  void hash_reads(ContentHashes* hashes) { hashes_ = hashes; }

  // Reads everything once. NaN and infinity are an Error naming file, mesh and triangle, unless
  // skip_invalid. A pattern that matches no name is an Error (kUsage) with the nearest names,
  // unless allow_unmatched. An unknown or broken file is an Error (kBadInput).
  SceneCounts stream(const TriangleSink& sink) const;
  // The box of the vertices that triangles use (one pass over the files). A scene without
  // triangles is an Error (kBadInput).
  Box bounds(SceneCounts* counts = nullptr) const;

  // The animations of all files, one file after the other.
  std::vector<Animation> animations() const;

  // Error (kBadInput): the scene has no triangles; with the patterns that matched nothing, and the
  // files that hold only points.
  [[noreturn]] void fail_empty(const SceneCounts& counts) const;

  // All files that determine the triangles: the scene's files, and the buffers that a .gltf names;
  // with `colours`, the images of both, and the .mtl files that an .obj names.
  void visit_files(const std::function<void(const File&)>& visit) const;
  // Records the state of all these files. Call before the scene is read.
  InputWatch watch() const;

  const SceneConfig& config() const { return config_; }

 private:
  SceneCounts read(const TriangleSink& sink, MeshBox* box_alone) const;
  // Reads the files once, posed at `time` unless it is null.
  LeftOut read_pose(const PoseTime* time, std::string_view frame, const NameFilter& names,
                    const TriangleSink& sink, MeshBox* box_alone, SceneCounts* counts) const;
  // The content of a scene file: `packed` itself or, if it is a gzip file, unpacked once.
  const File& content_of(const File& packed) const;

  SceneConfig config_;
  MemoryBudget* budget_;
  const SpillSpace* spill_;
  ContentHashes* hashes_ = nullptr;
  mutable std::map<std::string, File> unpacked_;  // by path
  mutable AlphaImages alpha_;
  mutable LinearImages images_;
};

}  // namespace svdag
