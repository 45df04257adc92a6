#include "io/scene/boundary_chain.h"

#include <numeric>
#include <random>

#include "streaming/file/checksum.h"

namespace svdag {
namespace {

uint64_t random_key() {
  std::random_device device;
  return uint64_t(device()) << 32 | device();
}

uint64_t magnitude(int64_t value) {
  return value < 0 ? -uint64_t(value) : uint64_t(value);
}

bool is_forward(const LatticePoint& d) {
  return d.x != 0 ? d.x > 0 : (d.y != 0 ? d.y > 0 : d.z > 0);
}

}  // namespace

HashSum::Hash hash_of_points(const LatticePoint& a, const LatticePoint& b) noexcept {
  static const uint64_t key = random_key();
  const std::array<int64_t, 6> words = {a.x, a.y, a.z, b.x, b.y, b.z};
  return hash128(std::as_bytes(std::span(words)), key);
}

void EdgeSum::add(const LatticeTriangle& triangle) {
  for (size_t i = 0; i < 3; ++i) {
    const LatticePoint &a = triangle.v[i], &b = triangle.v[(i + 1) % 3];
    const LatticePoint d = b - a;
    if (d == LatticePoint(0)) continue;
    const bool forward = is_forward(d);
    sum_.add(forward ? hash_of_points(a, b) : hash_of_points(b, a), forward);
  }
}

LatticePoint BoundaryChain::primitive_direction(const LatticePoint& a,
                                                const LatticePoint& b) noexcept {
  LatticePoint d = b - a;
  const uint64_t divisor = std::gcd(std::gcd(magnitude(d.x), magnitude(d.y)), magnitude(d.z));
  const bool forward = is_forward(d);
  // Vertices differ by less than 2^63, so the divisor fits.
  const int64_t signed_divisor = forward ? int64_t(divisor) : -int64_t(divisor);
  if (signed_divisor != 1) d /= signed_divisor;
  return d;
}

}  // namespace svdag
