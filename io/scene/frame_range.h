// The times of the frames of an animation: --frames A:B:STEP.
//
// All are whole multiples of 10^-decimals seconds, held as integers, so that no sum rounds and B is
// a frame exactly if steps from A lead to it. A pose takes the double next to the decimal, as
// --time does.
#pragma once

#include <cstdint>
#include <string>

namespace svdag {

struct FrameRange {
  uint64_t first = 0, step = 0;  // in 10^-decimals seconds
  uint32_t count = 0;            // 0: no frames
  int decimals = 0;

  bool empty() const { return count == 0; }
  // The time of frame i < count as a decimal, as long as that of every other one, so that names
  // sort by time: "00.25".
  std::string name(uint32_t i) const;
  // "0.00 to 1.00 by 0.25".
  std::string text() const;

  bool operator==(const FrameRange&) const = default;
};

// "A:B:STEP", decimals with 0 <= A <= B and 0 < STEP. Throws Error (kUsage), also for more frames
// than a file has layers.
FrameRange parse_frames(const std::string& text);
// A number of seconds. Throws Error (kUsage).
double parse_time(const std::string& text);

}  // namespace svdag
