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

}  // namespace

LatticePoint BoundaryChain::primitive_direction(const LatticePoint& a,
                                                const LatticePoint& b) noexcept {
  LatticePoint d = b - a;
  const uint64_t divisor =
      std::gcd(std::gcd(magnitude(d.x), magnitude(d.y)), magnitude(d.z));
  const bool forward = d.x != 0 ? d.x > 0 : (d.y != 0 ? d.y > 0 : d.z > 0);
  // Vertices differ by less than 2^63, so the divisor fits.
  const int64_t signed_divisor = forward ? int64_t(divisor) : -int64_t(divisor);
  if (signed_divisor != 1) d /= signed_divisor;
  return d;
}

BoundaryChain::Sum BoundaryChain::hash_of(const LatticePoint& direction,
                                          const LatticePoint& point) noexcept {
  static const uint64_t key = random_key();
  const std::array<int64_t, 6> words = {direction.x, direction.y, direction.z,
                                        point.x,     point.y,     point.z};
  return hash128(std::as_bytes(std::span(words)), key);
}

}  // namespace svdag
