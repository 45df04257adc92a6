#include "verify/trace/judge/embree.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>
#include <mutex>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kBytesPerTriangle =
    sizeof(VoxelTriangle) + 9 * sizeof(float) + 3 * sizeof(uint32_t);

// Books what Embree allocates; what the budget refuses ends the build with an error code.
class MemoryMonitor {
 public:
  explicit MemoryMonitor(MemoryBudget* budget) : reservation_(budget->reserve(0, kPurpose)) {}

  static bool count(void* self, ssize_t bytes, bool) {
    return static_cast<MemoryMonitor*>(self)->count(bytes);
  }
  void rethrow() const {
    if (refusal_) throw Error(*refusal_);
  }

 private:
  static constexpr const char* kPurpose = "nodes of Embree's tree";

  bool count(ssize_t bytes) {
    const std::lock_guard lock(mutex_);
    held_ += bytes;
    try {
      reservation_.resize(uint64_t(std::max<int64_t>(held_, 0)), kPurpose);
    } catch (const Error& error) {
      if (!refusal_) refusal_.emplace(error);
      return false;
    }
    return true;
  }

  std::mutex mutex_;
  int64_t held_ = 0;
  MemoryBudget::Reservation reservation_;
  std::optional<Error> refusal_;
};

[[noreturn]] void fail_embree(RTCError code) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error(ExitCode::kInternal, "Embree failed with code " + std::to_string(int(code)));
}

// What the filter needs to ask a proposed hit again.
struct Question {
  RTCIntersectContext context;
  const TriangleTracer* tracer;
  const Ray* ray;
  double begin, end;
  TriangleHit best;
};

TriangleHit hit_of(const Question& question, uint32_t triangle, const Crossing& crossing) {
  const bool doubtful =
      crossing.inside < question.tracer->doubt() || crossing.cosine < TriangleTracer::kGrazing;
  return {triangle, crossing.t, crossing.cosine, doubtful};
}

// Embree drops a proposed hit whose valid[0] is cleared and searches on.
void ask_again(const RTCFilterFunctionNArguments* arguments) {
  Question& question = *reinterpret_cast<Question*>(arguments->context);
  const uint32_t id = RTCHitN_primID(arguments->hit, 1, 0);
  const Crossing crossing = cross_plane(*question.ray, question.tracer->triangles()[id]);
  const double doubt = question.tracer->doubt();
  if (!crossing.found || crossing.inside < -doubt || crossing.t < question.begin ||
      crossing.t > question.end) {
    arguments->valid[0] = 0;
    return;
  }
  if (crossing.t < question.best.t) question.best = hit_of(question, id, crossing);
}

struct Nearest {
  const TriangleTracer* tracer;
  Vec3 point;
  double least;
};

bool come_nearer(RTCPointQueryFunctionArguments* arguments) {
  Nearest& nearest = *static_cast<Nearest*>(arguments->userPtr);
  const double d = distance(nearest.point, nearest.tracer->triangles()[arguments->primID]);
  if (d >= nearest.least) return false;
  nearest.least = d;
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
  std::vector<float> vertices;  // three a triangle, and one float that Embree reads past the end
  std::vector<uint32_t> corners;
};

TriangleTracer::TriangleTracer(const Vec3& middle, uint64_t most, size_t threads,
                               MemoryBudget* budget)
    : middle_(middle) {
  if (most > UINT32_MAX / 3)
    fail_usage("the scene has more than 2^32 / 3 triangles, whose corners Embree cannot number");
  reservation_ = budget->reserve(most * kBytesPerTriangle, "triangles for Embree");
  scene_ = std::make_unique<Scene>(threads, budget);
  triangles_.reserve(most);
  scene_->vertices.reserve(9 * most + 1);
}

TriangleTracer::~TriangleTracer() = default;

void TriangleTracer::add(std::span<const LatticeTriangle> triangles, int fraction) {
  for (const LatticeTriangle& lattice : triangles) {
    const VoxelTriangle t = in_voxels(lattice, fraction);
    triangles_.push_back(t);
    for (const Vec3& v : t.v) {
      for (int a = 0; a < 3; ++a) {
        reach_ = std::max(reach_, std::abs(v[a] - middle_[a]));
        scene_->vertices.push_back(float(v[a] - middle_[a]));
      }
    }
  }
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
  rtcSetGeometryIntersectFilterFunction(mesh, &ask_again);
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(scene_->scene, mesh);
  rtcReleaseGeometry(mesh);
  rtcCommitScene(scene_->scene);
  scene_->check();
}

std::optional<TriangleHit> TriangleTracer::closest(const Ray& ray, double begin, double end) const {
  Question question{{}, this, &ray, begin, end, {}};
  question.best.t = std::numeric_limits<double>::infinity();
  rtcInitIntersectContext(&question.context);
  RTCRayHit query{};
  const Vec3 origin = ray.origin - middle_;
  query.ray.org_x = float(origin[0]);
  query.ray.org_y = float(origin[1]);
  query.ray.org_z = float(origin[2]);
  query.ray.dir_x = float(ray.direction[0]);
  query.ray.dir_y = float(ray.direction[1]);
  query.ray.dir_z = float(ray.direction[2]);
  query.ray.tnear = std::max(0.0F, float(begin - float_error()));
  query.ray.tfar = float(end + float_error());
  query.ray.mask = ~0U;
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &question.context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return question.best;
}

double TriangleTracer::distance_to(const Vec3& point, double within) const {
  Nearest nearest{this, point, within};
  const Vec3 p = point - middle_;
  RTCPointQuery query{float(p[0]), float(p[1]), float(p[2]), 0, float(within + float_error())};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_->scene, &query, &context, &come_nearer, &nearest);
  return nearest.least < within ? nearest.least : std::numeric_limits<double>::infinity();
}

}  // namespace svdag
