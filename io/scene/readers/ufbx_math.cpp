// The functions that ufbx calculates with, in an object of their own. Only sine, cosine and what
// rounds exactly decide positions: they turn the angles of nodes into rotations. The others, of the
// C library, are for cameras and curves, which are not read.
#include <cmath>

#include "io/trigonometry.h"

extern "C" {
double ufbx_sqrt(double x) {
  return std::sqrt(x);
}
double ufbx_sin(double x) {
  return svdag::sine_of_angle(x);
}
double ufbx_cos(double x) {
  return svdag::cosine_of_angle(x);
}
double ufbx_tan(double x) {
  return std::tan(x);
}
double ufbx_asin(double x) {
  return std::asin(x);
}
double ufbx_acos(double x) {
  return std::acos(x);
}
double ufbx_atan(double x) {
  return std::atan(x);
}
double ufbx_atan2(double y, double x) {
  return std::atan2(y, x);
}
double ufbx_pow(double x, double y) {
  return std::pow(x, y);
}
double ufbx_fmin(double a, double b) {
  return std::fmin(a, b);
}
double ufbx_fmax(double a, double b) {
  return std::fmax(a, b);
}
double ufbx_fabs(double x) {
  return std::fabs(x);
}
double ufbx_copysign(double x, double y) {
  return std::copysign(x, y);
}
double ufbx_nextafter(double x, double y) {
  return std::nextafter(x, y);
}
double ufbx_rint(double x) {
  return std::rint(x);
}
double ufbx_floor(double x) {
  return std::floor(x);
}
double ufbx_ceil(double x) {
  return std::ceil(x);
}
int ufbx_isnan(double x) {
  return std::isnan(x);
}
}
