#include "builder/workspace/disk_need.h"

#include <algorithm>

#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/file/file_folder.h"

namespace svdag {
namespace {

constexpr uint64_t kBytesPerTriangle = 24;  // of a mesh in bins, with copies at borders
constexpr double kMinShare = 0.2;           // share of the work from which the rest is estimated

}  // namespace

void DiskNeed::check(uint64_t required, uint64_t estimated, const char* purpose) const {
  const uint64_t free = scratch_->folder()->free_bytes();
  if (required <= free) return;
  throw Error(ExitCode::kOutput,
              std::string("spilling the ") + purpose + " needs about " + format_bytes(estimated) +
                  " more, but the disk has only " + format_bytes(free) +
                  " free: free disk space, or give another --scratch or a larger --memory",
              scratch_->folder()->path());
}

void DiskNeed::expect_triangles(uint64_t count, uint64_t in_memory) {
  if (count <= in_memory) return;
  triangles_ = count * kBytesPerTriangle;
  check(triangles_ / 2, triangles_, "triangles");
}

void DiskNeed::expect_spilled(uint64_t count, uint64_t read, uint64_t bytes) {
  count = std::max(count, read);  // 0: the number is unknown
  // At least `bytes`: rounding may lose a byte.
  triangles_ = std::max(bytes, uint64_t(double(bytes) * double(count) / double(read)));
  check((triangles_ - bytes) / 2, triangles_ - bytes, "triangles");
}

void DiskNeed::expect_records(uint64_t bytes, uint64_t in_memory, const char* purpose) {
  if (bytes <= in_memory) return;
  records_ = bytes;
  check(records_, records_, purpose);
}

void DiskNeed::expect_runs(uint64_t bytes, double share) {
  if (share < kMinShare) return;
  runs_ = uint64_t(double(bytes) / share);
  if (runs_ > bytes) check((runs_ - bytes) / 2, runs_ - bytes, "nodes");
}

void DiskNeed::expect_output(const std::string& path, uint64_t min_bytes) const {
  const uint64_t free = free_bytes_of(folder_of(path));
  if (min_bytes <= free) return;
  throw Error(ExitCode::kOutput,
              "needs at least " + format_bytes(min_bytes) + ", but the disk has only " +
                  format_bytes(free) + " free: free disk space, or choose another output",
              path);
}

}  // namespace svdag
