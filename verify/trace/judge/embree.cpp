#include "verify/trace/judge/embree.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>
#include <mutex>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kBytesPerTriangle =
    sizeof(VoxelTriangle) + 9 * sizeof(float) + 4 * sizeof(uint32_t);

// Reserves what Embree allocates. If the budget rejects an allocation, the build fails and
// rethrow() throws the budget's Error.
class MemoryMonitor {
 public:
  explicit MemoryMonitor(MemoryBudget* budget) : reservation_(budget->reserve(0, kPurpose)) {}

  static bool count(void* self, ssize_t bytes, bool) {
    return static_cast<MemoryMonitor*>(self)->count(bytes);
  }
  void rethrow() const {
    if (error_) throw Error(*error_);
  }

 private:
  static constexpr const char* kPurpose = "nodes of Embree's tree";

  bool count(ssize_t bytes) {
    const std::lock_guard lock(mutex_);
    held_ += bytes;
    try {
      reservation_.resize(uint64_t(std::max<int64_t>(held_, 0)), kPurpose);
    } catch (const Error& error) {
      if (!error_) error_.emplace(error);
      return false;
    }
    return true;
  }

  std::mutex mutex_;
  int64_t held_ = 0;
  MemoryBudget::Reservation reservation_;
  std::optional<Error> error_;
};

[[noreturn]] void fail_embree(RTCError code) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error(ExitCode::kInternal, "Embree failed with code " + std::to_string(int(code)));
}

// A ray query. The context comes first: Embree passes its address to the filter.
struct RayQuery {
  RTCIntersectContext context;
  const TriangleTracer* tracer;
  const Ray* ray;
  double begin, end;
  TriangleHit best;
};

TriangleHit hit_of(const RayQuery& query, uint32_t triangle, const Crossing& crossing) {
  const bool doubtful =
      crossing.inside < query.tracer->doubt() || crossing.cosine < TriangleTracer::kGrazing;
  return {triangle, crossing.t, crossing.cosine, doubtful};
}

// Rechecks a proposed hit in double. Embree discards it and continues if valid[0] is cleared.
void recheck_hit(const RTCFilterFunctionNArguments* arguments) {
  RayQuery& query = *reinterpret_cast<RayQuery*>(arguments->context);
  const uint32_t id = RTCHitN_primID(arguments->hit, 1, 0);
  const Crossing crossing = cross_plane(*query.ray, query.tracer->triangles()[id]);
  const double doubt = query.tracer->doubt();
  if (!crossing.found || crossing.inside < -doubt || crossing.t < query.begin ||
      crossing.t > query.end ||
      !query.tracer->is_opaque(id, query.ray->origin + query.ray->direction * crossing.t)) {
    arguments->valid[0] = 0;
    return;
  }
  if (crossing.t < query.best.t) query.best = hit_of(query, id, crossing);
}

struct PointQuery {
  const TriangleTracer* tracer;
  Vec3 point;
  double distance;  // of the nearest triangle so far
};

bool update_nearest(RTCPointQueryFunctionArguments* arguments) {
  PointQuery& nearest = *static_cast<PointQuery*>(arguments->userPtr);
  const double d = distance(nearest.point, nearest.tracer->triangles()[arguments->primID]);
  if (d >= nearest.distance) return false;
  nearest.distance = d;
  const float radius = float(d + nearest.tracer->float_error());
  if (radius >= arguments->query->radius) return false;
  arguments->query->radius = radius;
  return true;
}

}  // namespace

struct TriangleTracer::Scene {
  Scene(size_t threads, MemoryBudget* budget)
      : monitor(budget), device(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
    if (device == nullptr) fail_embree(rtcGetDeviceError(nullptr));
    rtcSetDeviceMemoryMonitorFunction(device, &MemoryMonitor::count, &monitor);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  }
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  void check() const {
    monitor.rethrow();
    const RTCError code = rtcGetDeviceError(device);
    if (code != RTC_ERROR_NONE) fail_embree(code);
  }

  MemoryMonitor monitor;
  RTCDevice device;
  RTCScene scene = nullptr;
  std::vector<float> vertices;  // three per triangle, and one float that Embree reads past the end
  std::vector<uint32_t> corners;
};

TriangleTracer::TriangleTracer(const Vec3& middle, uint64_t max_triangles, size_t threads,
                               MemoryBudget* budget)
    : middle_(middle) {
  if (max_triangles > UINT32_MAX / 3)
    fail_usage("the scene has more than 2^32 / 3 triangles, whose corners Embree cannot number");
  reservation_ = budget->reserve(max_triangles * kBytesPerTriangle, "triangles for Embree");
  scene_ = std::make_unique<Scene>(threads, budget);
  triangles_.reserve(max_triangles);
  scene_->vertices.reserve(9 * max_triangles + 1);
}

TriangleTracer::~TriangleTracer() = default;

void TriangleTracer::add(std::span<const LatticeTriangle> triangles, int fraction) {
  for (const LatticeTriangle& lattice : triangles) {
    const VoxelTriangle t = in_voxels(lattice, fraction);
    triangles_.push_back(t);
    if (lattice.cut != 0) {
      cut_.resize(triangles_.size() - 1);
      cut_.push_back(lattice.cut);
    }
    for (const Vec3& v : t.v) {
      for (int a = 0; a < 3; ++a) {
        reach_ = std::max(reach_, std::abs(v[a] - middle_[a]));
        scene_->vertices.push_back(float(v[a] - middle_[a]));
      }
    }
  }
}

bool TriangleTracer::is_opaque(uint32_t triangle, const Vec3& point) const {
  if (triangle >= cut_.size() || cut_[triangle] == 0) return true;
  const CutRecord& record = cuts_.records[cut_[triangle] - 1];
  return is_surely_opaque(cuts_.cut_outs[record.material], record.corners, triangles_[triangle],
                          point, doubt());
}

void TriangleTracer::build() {
  const size_t count = triangles_.size();
  scene_->vertices.push_back(0);
  scene_->corners.resize(3 * count);
  for (size_t i = 0; i < scene_->corners.size(); ++i) scene_->corners[i] = uint32_t(i);
  const RTCGeometry mesh = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             scene_->vertices.data(), 0, 3 * sizeof(float), 3 * count);
  rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             scene_->corners.data(), 0, 3 * sizeof(uint32_t), count);
  rtcSetGeometryIntersectFilterFunction(mesh, &recheck_hit);
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(scene_->scene, mesh);
  rtcReleaseGeometry(mesh);
  rtcCommitScene(scene_->scene);
  scene_->check();
}

std::optional<TriangleHit> TriangleTracer::closest(const Ray& ray, double begin, double end) const {
  RayQuery query{{}, this, &ray, begin, end, {}};
  query.best.t = std::numeric_limits<double>::infinity();
  rtcInitIntersectContext(&query.context);
  RTCRayHit embree_ray{};
  const Vec3 origin = ray.origin - middle_;
  embree_ray.ray.org_x = float(origin[0]);
  embree_ray.ray.org_y = float(origin[1]);
  embree_ray.ray.org_z = float(origin[2]);
  embree_ray.ray.dir_x = float(ray.direction[0]);
  embree_ray.ray.dir_y = float(ray.direction[1]);
  embree_ray.ray.dir_z = float(ray.direction[2]);
  embree_ray.ray.tnear = std::max(0.0F, float(begin - float_error()));
  embree_ray.ray.tfar = float(end + float_error());
  embree_ray.ray.mask = ~0U;
  embree_ray.hit.geomID = embree_ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &query.context, &embree_ray);
  if (embree_ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return query.best;
}

double TriangleTracer::distance_to(const Vec3& point, double within) const {
  PointQuery nearest{this, point, within};
  const Vec3 p = point - middle_;
  RTCPointQuery query{float(p[0]), float(p[1]), float(p[2]), 0, float(within + float_error())};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_->scene, &query, &context, &update_nearest, &nearest);
  return nearest.distance < within ? nearest.distance : std::numeric_limits<double>::infinity();
}

}  // namespace svdag
