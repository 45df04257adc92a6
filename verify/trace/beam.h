// Beams: one coarse traversal gives a tile of rays the time before which none of them can hit.
//
// Idea: Laine and Karras 2010; Kaempe, Sintorn, Assarsson 2013. A tile of 8 x 8 pixels is a thin
// pyramid; its rays share their origin and differ little in direction.
#pragma once

#include "verify/trace/camera.h"

namespace svdag {

constexpr uint32_t kTile = 8;  // pixels a side

}  // namespace svdag
