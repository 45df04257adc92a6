// A frame of an animation: a mesh that sways, all of it or the top tenth of its surface.
#pragma once

#include "tests/scenes/mesh.h"

namespace svdag::scenes {

enum class MovingPart { kAll, kTenth };

class MovingMesh : public Mesh {
 public:
  // Frame `frame` of `frames`, which are one period. `mesh` must outlive this.
  MovingMesh(const Mesh& mesh, uint64_t frame, uint64_t frames, MovingPart moving)
      : mesh_(mesh), time_(double(frame) / double(frames)), moving_(moving) {}

  uint64_t vertices() const override { return mesh_.vertices(); }
  uint64_t faces() const override { return mesh_.faces(); }
  Face face(uint64_t i) const override { return mesh_.face(i); }
  std::string part(uint64_t i) const override { return mesh_.part(i); }
  std::string material(uint64_t i) const override { return mesh_.material(i); }
  Charts charts(uint64_t i) const override { return mesh_.charts(i); }
  Point vertex(uint64_t i) const override;

 private:
  const Mesh& mesh_;
  double time_;
  MovingPart moving_;
};

}  // namespace svdag::scenes
