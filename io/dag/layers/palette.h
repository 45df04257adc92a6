// Colours for layers whose source has none.
#pragma once

#include <string_view>

#include "io/colour.h"

namespace svdag {

// One of 48 hues in 3 tones, chosen by the name.
Colour palette_colour(std::string_view name);

}  // namespace svdag
