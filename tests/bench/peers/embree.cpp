#include "tests/bench/peers/embree.h"

#include <embree3/rtcore.h>

#include <ctime>
#include <vector>

namespace svdag::bench {
namespace {

// A packet of kWidth rays, and the functions of Embree that trace it.
template <class RayHit, class Ray, unsigned kWidth>
struct Packet {
  alignas(64) RayHit hits;
  alignas(64) int valid[kWidth];

  Ray& ray() { return hits.ray; }

  static std::vector<Packet> of(std::span<const FloatRay> rays) {
    std::vector<Packet> packets((rays.size() + kWidth - 1) / kWidth);
    for (size_t i = 0; i < packets.size() * kWidth; ++i) {
      Packet& p = packets[i / kWidth];
      const size_t k = i % kWidth;
      p.valid[k] = i < rays.size() ? -1 : 0;
      const FloatRay& r = rays[i < rays.size() ? i : 0];
      Ray& to = p.ray();
      to.org_x[k] = r.origin[0], to.org_y[k] = r.origin[1], to.org_z[k] = r.origin[2];
      to.dir_x[k] = r.direction[0], to.dir_y[k] = r.direction[1], to.dir_z[k] = r.direction[2];
      to.tnear[k] = to.time[k] = 0;
      to.tfar[k] = r.end;
      to.mask[k] = ~0U;
      to.id[k] = to.flags[k] = 0;
      p.hits.hit.geomID[k] = p.hits.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    return packets;
  }
  uint64_t hit_count() const {
    uint64_t count = 0;
    for (unsigned k = 0; k < kWidth; ++k)
      count += valid[k] != 0 && hits.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
    return count;
  }
  uint64_t blocked_count() const {
    uint64_t count = 0;
    for (unsigned k = 0; k < kWidth; ++k) count += valid[k] != 0 && hits.ray.tfar[k] < 0;
    return count;
  }
};

using Packet8 = Packet<RTCRayHit8, RTCRay8, 8>;
using Packet16 = Packet<RTCRayHit16, RTCRay16, 16>;

std::vector<RTCRayHit> single_rays(std::span<const FloatRay> rays) {
  std::vector<RTCRayHit> result(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    const FloatRay& r = rays[i];
    RTCRayHit& to = result[i];
    to.ray = {
        r.origin[0], r.origin[1], r.origin[2], 0, r.direction[0], r.direction[1], r.direction[2], 0,
        r.end,       ~0U,         0,           0};
    to.hit.geomID = to.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }
  return result;
}

template <class Run>
double seconds_of(const Run& run) {
  const double start = thread_seconds();
  run();
  return thread_seconds() - start;
}

template <class Packets, class Trace, class Count>
RayRun run_packets(Packets packets, const Trace& trace, const Count& count) {
  RayRun result;
  result.seconds = seconds_of([&] {
    for (auto& packet : packets) trace(packet);
  });
  for (const auto& packet : packets) result.hits += count(packet);
  return result;
}

constexpr auto kHits = [](const auto& packet) { return packet.hit_count(); };
constexpr auto kBlocked = [](const auto& packet) { return packet.blocked_count(); };

RTCIntersectContext context_of(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

}  // namespace

struct EmbreePeer::Scene {
  RTCDevice device;
  RTCScene scene;
  std::vector<uint32_t> corners;
};

EmbreePeer::EmbreePeer(std::span<const FloatTriangle> triangles)
    : scene_(std::make_unique<Scene>()) {
  Scene& s = *scene_;
  s.device = rtcNewDevice(nullptr);
  s.scene = rtcNewScene(s.device);
  rtcSetSceneBuildQuality(s.scene, RTC_BUILD_QUALITY_HIGH);
  const RTCGeometry mesh = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
  s.corners.resize(3 * triangles.size());
  for (size_t i = 0; i < s.corners.size(); ++i) s.corners[i] = uint32_t(i);
  float* to = static_cast<float*>(rtcSetNewGeometryBuffer(
      mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * triangles.size()));
  for (const FloatTriangle& t : triangles) {
    for (const auto& v : t.v) {
      for (const float x : v) *to++ = x;
    }
  }
  rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s.corners.data(), 0,
                             12, triangles.size());
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(s.scene, mesh);
  rtcReleaseGeometry(mesh);
  rtcCommitScene(s.scene);
}

EmbreePeer::~EmbreePeer() {
  rtcReleaseScene(scene_->scene);
  rtcReleaseDevice(scene_->device);
}

RayRun EmbreePeer::closest(std::span<const FloatRay> rays, Way way, bool coherent) const {
  RTCIntersectContext context = context_of(coherent);
  const RTCScene scene = scene_->scene;
  if (way == Way::kPacket8)
    return run_packets(
        Packet8::of(rays), [&](Packet8& p) { rtcIntersect8(p.valid, scene, &context, &p.hits); },
        kHits);
  if (way == Way::kPacket16)
    return run_packets(
        Packet16::of(rays), [&](Packet16& p) { rtcIntersect16(p.valid, scene, &context, &p.hits); },
        kHits);
  std::vector<RTCRayHit> single = single_rays(rays);
  RayRun result;
  result.seconds = seconds_of([&] {
    if (way == Way::kStream) {
      rtcIntersect1M(scene, &context, single.data(), uint32_t(single.size()), sizeof(RTCRayHit));
    } else {
      for (RTCRayHit& ray : single) rtcIntersect1(scene, &context, &ray);
    }
  });
  for (const RTCRayHit& ray : single) result.hits += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  return result;
}

RayRun EmbreePeer::any(std::span<const FloatRay> rays, Way way, bool coherent) const {
  RTCIntersectContext context = context_of(coherent);
  const RTCScene scene = scene_->scene;
  if (way == Way::kPacket8)
    return run_packets(
        Packet8::of(rays), [&](Packet8& p) { rtcOccluded8(p.valid, scene, &context, &p.ray()); },
        kBlocked);
  if (way == Way::kPacket16)
    return run_packets(
        Packet16::of(rays), [&](Packet16& p) { rtcOccluded16(p.valid, scene, &context, &p.ray()); },
        kBlocked);
  const std::vector<RTCRayHit> with_hits = single_rays(rays);
  std::vector<RTCRay> single;
  single.reserve(rays.size());
  for (const RTCRayHit& ray : with_hits) single.push_back(ray.ray);
  RayRun result;
  result.seconds = seconds_of([&] {
    if (way == Way::kStream) {
      rtcOccluded1M(scene, &context, single.data(), uint32_t(single.size()), sizeof(RTCRay));
    } else {
      for (RTCRay& ray : single) rtcOccluded1(scene, &context, &ray);
    }
  });
  for (const RTCRay& ray : single) result.hits += ray.tfar < 0;
  return result;
}

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

}  // namespace svdag::bench
