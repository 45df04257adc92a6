// Traces a `.svdag` on a GPU into a picture:
//
//   svdag-vulkan build/trace city.svdag city.png 10,5,10 0,0,0 40 [pixels.bin]
//
// The camera is at the first point and looks at the second one, both in world coordinates, with y up and a vertical
// angle of view of 40 degrees. pixels.bin gets the pixels as trace.comp writes them.
#include <array>
#include <cmath>
#include <cstdio>

#include "compute.h"
#include "gpu_tables.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace {

using Vec = std::array<double, 3>;

constexpr uint32_t kWidth = 640, kHeight = 360;
constexpr size_t kBufferWords = size_t(1) << SVDAG_BUFFER_BITS;  // as in the shader, as is SVDAG_BUFFERS

// As in trace.comp.
struct Picture {
  int32_t eye[4];
  float inside[4];
  int32_t size[4];
  int32_t limbs[3][3][4];
};
struct Pixel {
  int32_t voxel[3];
  uint32_t face, layer, colour, shown;
  float t;
};

Vec point(const char* text) {
  Vec v;
  if (std::sscanf(text, "%lf,%lf,%lf", &v[0], &v[1], &v[2]) != 3) throw std::runtime_error("a point is x,y,z");
  return v;
}
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec normalized(const Vec& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

// In doubles, then divided into integers: a pixel's direction is then exact in the shader, too.
Picture look(const svdag::DagView& dag, const Vec& eye, const Vec& target, double degrees) {
  Picture picture = {};
  const Vec forward = normalized({target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]});
  const Vec right = normalized(cross(forward, {0, 1, 0})), up = cross(right, forward);
  const double slope = std::tan(degrees * 3.14159265358979323846 / 360), step = 2 * slope / kHeight;
  for (int a = 0; a < 3; ++a) {
    const double voxel = svdag::voxel_from_world(dag, a, eye[a]);
    picture.eye[a] = int32_t(std::floor(voxel));
    picture.inside[a] = float(voxel - picture.eye[a]);
    const double first = forward[a] + (0.5 - kWidth / 2.) * step * right[a] - (0.5 - kHeight / 2.) * step * up[a];
    const double parts[] = {first, step * right[a], -step * up[a]};
    for (int i = 0; i < 3; ++i) {
      double rest = parts[i];
      for (auto& limb : picture.limbs[i]) {
        rest *= 0x1p18;
        limb[a] = int32_t(std::floor(rest));
        rest -= limb[a];
      }
    }
  }
  picture.size[0] = kWidth;
  picture.size[1] = kHeight;
  return picture;
}

// The file, then its tables: in one buffer if they fit, for the shader without a switch, else in SVDAG_BUFFERS.
std::vector<Compute::Buffer> upload(const Compute& gpu, const svdag::DagFile& file, const std::vector<uint32_t>& tables) {
  std::vector<uint32_t> words(file.bytes().size() / 4);
  std::memcpy(words.data(), file.bytes().data(), file.bytes().size());
  words.insert(words.end(), tables.begin(), tables.end());
  if (words.size() > kBufferWords * SVDAG_BUFFERS) throw std::runtime_error("the file does not fit into the buffers");
  std::vector<Compute::Buffer> buffers;
  for (size_t at = 0; at < words.size(); at += kBufferWords) {
    const size_t bytes = 4 * std::min(words.size() - at, kBufferWords);
    buffers.push_back(gpu.storage(bytes));
    std::memcpy(buffers.back().data, &words[at], bytes);
  }
  return buffers;
}

void run(char** argv, const char* pixels_path) {
  const svdag::DagFile file = svdag::DagFile::open(argv[2]);
  Picture picture = look(file.view(), point(argv[4]), point(argv[5]), std::atof(argv[6]));
  picture.eye[3] = int32_t(file.bytes().size() / 4);
  picture.size[2] = !file.layers().layers.empty();
  picture.size[3] = file.has_colours();

  const Compute gpu;
  const auto buffers = upload(gpu, file, gpu_tables(file));
  const size_t pixels = kWidth * kHeight;
  const Compute::Buffer output = gpu.storage(sizeof(Picture) + pixels * sizeof(Pixel));
  std::memcpy(output.data, &picture, sizeof picture);
  const uint32_t count = buffers.size() == 1 ? 1 : SVDAG_BUFFERS;
  gpu.run(argv[1] + std::to_string(count) + ".spv", buffers, count, output, (kWidth + 7) / 8, (kHeight + 7) / 8);

  const Pixel* const traced = reinterpret_cast<const Pixel*>(static_cast<const Picture*>(output.data) + 1);
  std::vector<uint32_t> shown;
  for (size_t i = 0; i < pixels; ++i) shown.push_back(traced[i].shown);
  if (!stbi_write_png(argv[3], kWidth, kHeight, 4, shown.data(), 4 * kWidth))
    throw std::runtime_error(argv[3] + std::string(": cannot be written"));
  if (pixels_path)
    std::ofstream(pixels_path, std::ios::binary).write(reinterpret_cast<const char*>(traced), pixels * sizeof(Pixel));
  std::printf("%s: %s\n", argv[3], gpu.name().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 7 && argc != 8)
      throw std::runtime_error("usage: svdag-vulkan SHADER FILE PICTURE.png EYE TARGET DEGREES [PIXELS]");
    run(argv, argc == 8 ? argv[7] : nullptr);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "svdag-vulkan: %s\n", error.what()), 1;
  }
}
