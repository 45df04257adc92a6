#include "tests/scenes/textures.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "tests/scenes/numbers.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace svdag::scenes {
namespace {

Texel grey(double value) {
  return {value, value, value, 1};
}

Texel shaded(const Texel& texel, double light) {
  return texel * grey(light);
}

double smooth(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double fraction(double x) {
  return x - std::floor(x);
}

// Value noise in [0, 1] that repeats with [0, 1]^2, of `cells` cells along a side.
double noise(uint64_t seed, double u, double v, int cells) {
  const double x = fraction(u) * cells, y = fraction(v) * cells;
  const int i = int(x), j = int(y);
  const auto value = [&](int di, int dj) {
    return uniform(hash(seed, uint64_t((j + dj) % cells)), uint64_t((i + di) % cells));
  };
  const double s = smooth(0, 1, x - i), t = smooth(0, 1, y - j);
  return glm::mix(glm::mix(value(0, 0), value(1, 0), s), glm::mix(value(0, 1), value(1, 1), s), t);
}

// Sum of `octaves` noises, each of twice the frequency and half the amplitude; within [0, 1].
double turbulence(uint64_t seed, double u, double v, int cells, int octaves) {
  double sum = 0, amplitude = 0.5;
  for (int octave = 0; octave < octaves; ++octave, cells *= 2, amplitude /= 2)
    sum += amplitude * noise(seed + uint64_t(octave), u, v, cells);
  return sum;
}

// Rows of stones, each row shifted by half a stone.
struct Bond {
  uint64_t stone;
  double edge_u, edge_v;  // to the nearest edge, as a share of the image
};
Bond bond(double u, double v, int columns, int rows, double shift) {
  const double y = fraction(v) * rows, x = fraction(u) * columns + (int(y) % 2 ? shift : 0);
  const double in_x = fraction(x), in_y = fraction(y);
  return {hash(uint64_t(y), uint64_t(int(x) % columns)), std::min(in_x, 1 - in_x) / columns,
          std::min(in_y, 1 - in_y) / rows};
}

// 0 in a joint of this half width, 1 on the stones.
double off_joint(const Bond& at, double half) {
  return smooth(half, 2 * half, std::min(at.edge_u, at.edge_v));
}

Texel limestone(double u, double v) {
  const Bond at = bond(u, v, 3, 6, 0.5);
  const double age = turbulence(11, u, v, 8, 5), grain = noise(17, u, v, 256);
  const Texel block =
      glm::mix(Texel(0.84, 0.77, 0.63, 1), Texel(0.79, 0.67, 0.55, 1), 0.75 * uniform(at.stone, 1));
  const double light = 0.86 + 0.16 * uniform(at.stone, 2) + 0.16 * (age - 0.5) + 0.06 * grain;
  return glm::mix(Texel(0.50, 0.44, 0.36, 1), shaded(block, light), off_joint(at, 0.0022));
}

// How strongly a vein passes a point, 0 .. 1.
double vein(uint64_t seed, double u, double v, double sharpness) {
  const double wave = sin_turns(u + v + 1.3 * turbulence(seed, u, v, 3, 5));
  return std::max(0.0, 1 - sharpness * std::abs(wave));
}

Texel veined(const Texel& stone, const Texel& veins, double u, double v) {
  const double cloud = turbulence(23, u, v, 4, 4);
  const Texel base = shaded(stone, 0.8 + 0.4 * cloud);
  return glm::mix(base, veins, 0.75 * vein(31, u, v, 4) + 0.25 * vein(47, v, u, 8));
}

Texel marble(double u, double v) {
  return veined({0.66, 0.40, 0.34, 1}, {0.93, 0.86, 0.80, 1}, u, v);
}

Texel bricks(double u, double v) {
  const Bond at = bond(u, v, 8, 24, 0.5);
  const double tone = uniform(at.stone, 3);
  const Texel burnt = glm::mix(Texel(0.66, 0.31, 0.22, 1), Texel(0.80, 0.50, 0.34, 1), tone);
  const Texel brick = uniform(at.stone, 4) < 0.12 ? Texel(0.47, 0.25, 0.21, 1) : burnt;
  const double light = 0.8 + 0.4 * turbulence(53, u, v, 32, 4);
  const Texel mortar = shaded({0.80, 0.74, 0.65, 1}, 0.85 + 0.2 * noise(59, u, v, 128));
  return glm::mix(mortar, shaded(brick, light), off_joint(at, 0.0022));
}

Texel mosaic(double u, double v) {
  const int i = int(u * 4), j = int(v * 4);
  const double shift = 0.37 * (i + 4 * j);  // each tile is another piece of stone
  const bool light = (i + j) % 2 == 0;
  Texel tile = light ? veined({0.86, 0.81, 0.70, 1}, {0.70, 0.60, 0.48, 1}, u + shift, v)
                     : veined({0.30, 0.40, 0.38, 1}, {0.62, 0.68, 0.62, 1}, u, v + shift);
  const double x = std::abs(2 * fraction(4 * u) - 1), y = std::abs(2 * fraction(4 * v) - 1);
  const Texel red = shaded({0.58, 0.20, 0.15, 1}, 0.85 + 0.3 * turbulence(61, u, v, 16, 3));
  tile = glm::mix(tile, red, smooth(1.58, 1.61, x + y));
  // An eight-pointed star: the union of two squares, with a border, around a flower.
  const double a = std::abs(u - 0.5), b = std::abs(v - 0.5);
  const double star = std::min(std::max(a, b), (a + b) * 0.70710678);
  const Texel gold = shaded({0.83, 0.64, 0.30, 1}, 0.85 + 0.3 * turbulence(67, u, v, 16, 3));
  tile = glm::mix(tile, {0.22, 0.14, 0.12, 1}, 1 - smooth(0.185, 0.189, star));
  tile = glm::mix(tile, gold, 1 - smooth(0.170, 0.174, star));
  tile = glm::mix(tile, {0.16, 0.24, 0.40, 1}, 1 - smooth(0.092, 0.096, std::max(a, b)));
  return glm::mix(tile, {0.90, 0.85, 0.74, 1}, 1 - smooth(0.060, 0.064, a + b));
}

Texel terracotta(double u, double v) {
  const Bond at = bond(u, v, 4, 4, 0);
  const Texel tile =
      glm::mix(Texel(0.62, 0.40, 0.30, 1), Texel(0.74, 0.52, 0.38, 1), uniform(at.stone, 5));
  const double light = 0.8 + 0.4 * turbulence(71, u, v, 16, 4);
  return glm::mix(Texel(0.42, 0.36, 0.31, 1), shaded(tile, light), off_joint(at, 0.004));
}

// A flower of four petals around the origin: r^4 cos(4 angle) by the polynomial, so without angles.
double flower(double x, double y) {
  const double r2 = x * x + y * y, petals = x * x * x * x - 6 * x * x * y * y + y * y * y * y;
  return r2 < 1e-12 ? 0 : std::sqrt(r2) * (1 - 0.3 * petals / (r2 * r2));
}

Texel brocade(const Texel& cloth, double u, double v) {
  const Texel gold{0.86, 0.68, 0.34, 1};
  const double weave = 0.92 + 0.08 * sin_turns(64 * u) * sin_turns(64 * v);
  const double swing = 0.25 * cos_turns(v);
  double ogee = 1, blossom = 1;  // distances to lines and flowers
  for (const double shift : {-1.0, 0.0, 1.0}) {
    for (const double side : {-swing, swing})
      ogee = std::min(ogee, std::abs(u - 0.5 - side + shift));
    for (const double up : {0.0, 0.5, 1.0})
      blossom = std::min(blossom, flower(u - 0.5 + shift, v - up));
    for (const double up : {0.25, 0.75}) blossom = std::min(blossom, flower(u + shift, v - up));
  }
  const double lines = 1 - smooth(0.014, 0.022, std::abs(ogee - 0.03));
  const double petals = smooth(0.03, 0.036, blossom) * (1 - smooth(0.1, 0.106, blossom));
  return shaded(glm::mix(cloth, gold, std::max(lines, petals)), weave);
}

Texel red_brocade(double u, double v) {
  return brocade({0.66, 0.09, 0.12, 1}, u, v);
}

Texel blue_brocade(double u, double v) {
  return brocade({0.12, 0.24, 0.56, 1}, u, v);
}

// v from the stem to the tip, u across. Leaflets point from the rib to the tip.
Texel fern(double u, double v) {
  const double across = std::abs(2 * u - 1), along = 14 * v - 2.2 * across;
  const double middle = std::abs(fraction(along) - 0.5);  // of a leaflet
  const bool rib = across < 0.1, leaflet = middle < 0.36 * (1.05 - across * across);
  const Texel green = glm::mix(Texel(0.16, 0.36, 0.12, 1), Texel(0.48, 0.66, 0.24, 1),
                               0.7 * across + 0.3 * noise(73, u, v, 16));
  Texel leaf = rib ? Texel(0.60, 0.66, 0.36, 1) : shaded(green, 1.1 - 0.9 * middle);
  leaf.a = rib || leaflet ? 1 : 0;
  return leaf;
}

// Cells of the atlas: u once around, v from the foot to the rim.
Texel red_vase(double u, double v) {
  const Texel clay = shaded({0.76, 0.42, 0.24, 1}, 0.85 + 0.3 * turbulence(79, u, v, 8, 4));
  const double zigzag = std::abs(v - 0.50 - 0.09 * std::abs(2 * fraction(12 * u) - 1) + 0.045);
  const bool line = std::abs(v - 0.40) < 0.012 || std::abs(v - 0.60) < 0.012 || v < 0.06;
  return line || zigzag < 0.02 ? Texel(0.14, 0.10, 0.09, 1) : clay;
}

Texel blue_vase(double u, double v) {
  const Texel glaze = shaded({0.90, 0.91, 0.88, 1}, 0.9 + 0.15 * noise(83, u, v, 8));
  const double wave = std::abs(v - 0.48 - 0.05 * sin_turns(8 * u));
  const double dots = flower(fraction(8 * u) - 0.5, (v - 0.34) * 5);
  const bool line = std::abs(v - 0.60) < 0.015 || v < 0.08 || v > 0.86;
  return line || wave < 0.022 || dots < 0.22 ? Texel(0.13, 0.26, 0.60, 1) : glaze;
}

Texel green_vase(double u, double v) {
  const double drip = 0.42 + 0.10 * noise(89, u, 0.5, 16);
  const Texel glaze = shaded({0.20, 0.45, 0.33, 1}, 0.8 + 0.5 * turbulence(97, u, v, 8, 4));
  const Texel clay = shaded({0.72, 0.55, 0.38, 1}, 0.85 + 0.3 * noise(101, u, v, 32));
  return glm::mix(clay, glaze, smooth(drip, drip + 0.02, v));
}

Texel capital(double u, double v) {
  const double leaf = std::abs(2 * fraction(8 * u) - 1), height = 0.45 + 0.4 * (1 - leaf * leaf);
  const Texel stone = shaded({0.86, 0.79, 0.66, 1}, 0.9 + 0.2 * turbulence(103, u, v, 8, 4));
  const Texel gold{0.84, 0.64, 0.28, 1}, blue{0.22, 0.32, 0.50, 1};
  if (v < 0.32 || v > 0.93) return gold;
  if (std::abs(v - height) < 0.03 || leaf < 0.08) return gold;
  return v < height ? shaded(stone, 1.05 - 0.35 * leaf) : blue;
}

Texel painted(double u, double v) {
  constexpr Texel (*kCells[])(double, double) = {red_vase, blue_vase, green_vase, capital};
  return kCells[(v < 0.5 ? 0 : 2) + (u < 0.5 ? 0 : 1)](fraction(2 * u), fraction(2 * v));
}

}  // namespace

const Texture kLimestone{512, 512, true, false, limestone};
const Texture kMarble{256, 256, true, false, marble};
const Texture kBricks{512, 512, false, false, bricks};
const Texture kMosaic{512, 512, false, false, mosaic};
const Texture kTerracotta{256, 256, true, false, terracotta};
const Texture kRedBrocade{128, 128, false, false, red_brocade};
const Texture kBlueBrocade{128, 128, false, false, blue_brocade};
const Texture kFern{64, 256, false, true, fern};
const Texture kPainted{256, 256, false, false, painted};

std::string encoded(const Texture& texture) {
  const int channels = texture.mask ? 4 : 3;
  std::vector<uint8_t> bytes;
  for (int y = 0; y < texture.height; ++y) {
    for (int x = 0; x < texture.width; ++x) {
      const Texel texel = texture.paint((x + 0.5) / texture.width, (y + 0.5) / texture.height);
      for (int c = 0; c < channels; ++c)
        bytes.push_back(uint8_t(255 * std::clamp(texel[c], 0.0, 1.0) + 0.5));
    }
  }
  std::string file;
  const auto append = [](void* out, void* data, int size) {
    static_cast<std::string*>(out)->append(static_cast<const char*>(data), size_t(size));
  };
  if (texture.jpeg)
    stbi_write_jpg_to_func(append, &file, texture.width, texture.height, channels, bytes.data(),
                           92);
  else
    stbi_write_png_to_func(append, &file, texture.width, texture.height, channels, bytes.data(),
                           texture.width * channels);
  return file;
}

}  // namespace svdag::scenes
