// Parses and prints numbers with units: resolutions ("64K"), sizes ("4G"). K, M, G, T are powers
// of 1024.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/grid.h"

namespace svdag {

// "512" | "64K" | "4G" -> count; also "4GiB", "4GB". Throws Error (kUsage) naming `option`.
uint64_t parse_count(std::string_view text, const char* option);
// A resolution N = 2^L from "8" to "1M" -> L in 3 .. 20. Throws Error (kUsage).
int parse_resolution(std::string_view text);
// --bounds: "x0,y0,z0,x1,y1,z1", the minimum first. Throws Error (kUsage).
Box parse_bounds(const std::string& text, const char* option = "--bounds");
// --units: mm, cm, m, km, in or ft -> its length in metres. Throws Error (kUsage).
double parse_unit(const std::string& text);
// --voxel-size: "0.5", or "5cm" if the scene's `unit` (in metres) is known, not 0 -> the size in
// units of the scene. Throws Error (kUsage).
double parse_voxel_size(const std::string& text, double unit);
// --origin: "x,y,z". Throws Error (kUsage).
Point parse_origin(const std::string& text);
// --cube: "x,y,z,side". Throws Error (kUsage).
GridCube parse_cube(const std::string& text);
// 65536 -> "64K", 1000 -> "1000".
std::string format_resolution(uint64_t resolution);
// 1536 -> "1.5 KiB".
std::string format_bytes(uint64_t bytes);
// 1234567 -> "1,234,567".
std::string format_count(uint64_t count);
// "1 layer", "2,000 layers".
std::string format_count(uint64_t count, const std::string& noun);
// "(1, 0.5, -2)", to 9 digits.
std::string format_point(const Point& p);
// The shortest decimal text that reads back as exactly `value`.
std::string format_double(double value);

// The range of values of a float grid that count as set (--iso=LOW,HIGH).
struct ValueRange {
  double low, high;
};

// Parses "LOW,HIGH", which may be -inf and inf; anything else is an Error (kUsage).
ValueRange parse_iso(const std::string& text);

}  // namespace svdag
