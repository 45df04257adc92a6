// The names of the classes of points in LAS files (ASPRS LAS 1.4 R15, table 17).
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace svdag {

// "class N" for numbers that the standard reserves or leaves to the user.
inline std::string las_class_name(uint8_t number) {
  constexpr std::array<const char*, 19> kNames = {"never classified",
                                                  "unclassified",
                                                  "ground",
                                                  "low vegetation",
                                                  "medium vegetation",
                                                  "high vegetation",
                                                  "building",
                                                  "low noise",
                                                  nullptr,
                                                  "water",
                                                  "rail",
                                                  "road surface",
                                                  nullptr,
                                                  "wire guard",
                                                  "wire conductor",
                                                  "transmission tower",
                                                  "wire connector",
                                                  "bridge deck",
                                                  "high noise"};
  if (number < kNames.size() && kNames[number] != nullptr) return kNames[number];
  return "class " + std::to_string(number);
}

}  // namespace svdag
