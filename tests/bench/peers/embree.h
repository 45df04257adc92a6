// Embree in its usual configuration: one mesh, high build quality; single rays, packets and
// streams.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace svdag::bench {

struct FloatTriangle {
  float v[3][3];
};

// A ray relative to the same origin as the triangles, from t = 0.
struct FloatRay {
  float origin[3];
  float direction[3];
  float end;
};

struct RayRun {
  double seconds = 0;  // CPU time of this thread
  uint64_t hits = 0;
};

class EmbreePeer {
 public:
  enum class Way { kSingle, kPacket8, kPacket16, kStream };

  // `triangles` must outlive this.
  explicit EmbreePeer(std::span<const FloatTriangle> triangles);
  ~EmbreePeer();

  // Traces all rays, singly or `way` many at once; the conversion to Embree's layout is not timed.
  // `coherent`: neighbouring rays are similar.
  RayRun closest(std::span<const FloatRay> rays, Way way, bool coherent) const;
  RayRun any(std::span<const FloatRay> rays, Way way, bool coherent) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

// CPU time of this thread, so that other load does not count.
double thread_seconds();

}  // namespace svdag::bench
