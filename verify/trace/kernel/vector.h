// Operations on Vec3 for cameras, sampling and shading, for host and CUDA.
#pragma once

#include "verify/trace/kernel/traverse.h"

namespace svdag {

constexpr double kPi = 3.14159265358979323846;

SVDAG_HD inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}
SVDAG_HD inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
SVDAG_HD inline Vec3 operator*(const Vec3& a, double s) {
  return {{a[0] * s, a[1] * s, a[2] * s}};
}
SVDAG_HD inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
SVDAG_HD inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
SVDAG_HD inline double length(const Vec3& a) {
  return square_root(dot(a, a));
}
SVDAG_HD inline Vec3 normalized(const Vec3& a) {
  return a * (1 / length(a));
}

}  // namespace svdag
