// Traces a `.svdag` on a GPU into a picture:
//
//   svdag-vulkan build/trace city.svdag city.png 10,5,10 0,0,0 40 [pixels.bin]
//
// The camera is at the first point and looks at the second one, not straight up, both in world coordinates with y up;
// its vertical angle of view is 40 degrees. pixels.bin gets the pixels as trace.comp writes them.
#include <cstdio>
#include <cstring>
#include <glm/glm.hpp>

#include "compute.h"
#include "gpu_tables.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace {

constexpr uint32_t kWidth = 640, kHeight = 360;
constexpr size_t kBufferWords = size_t(1) << SVDAG_BUFFER_BITS;  // as in the shader, as is SVDAG_BUFFERS

// As in trace.comp.
struct Picture {
  glm::ivec4 eye;
  glm::vec4 inside;
  glm::ivec4 size, limbs[3][3];
};
struct Pixel {
  glm::ivec3 voxel;
  uint32_t face, layer, colour, shown;
  float t;
};

glm::dvec3 point(const char* text) {
  glm::dvec3 v;
  if (std::sscanf(text, "%lf,%lf,%lf", &v.x, &v.y, &v.z) != 3) throw std::runtime_error("a point is x,y,z");
  return v;
}

// In doubles, then divided into integers, so that a pixel's direction is as exact in the shader.
Picture look(const svdag::DagView& dag, const glm::dvec3& eye, const glm::dvec3& target, double degrees) {
  Picture picture = {};
  picture.size = glm::ivec4(kWidth, kHeight, 0, 0);
  for (int a = 0; a < 3; ++a) {
    const double voxel = svdag::voxel_from_world(dag, a, eye[a]);
    picture.eye[a] = int32_t(glm::floor(voxel));
    picture.inside[a] = float(voxel - picture.eye[a]);
  }
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0))), up = glm::cross(right, forward);
  const double step = 2 * glm::tan(glm::radians(degrees) / 2) / kHeight;
  const glm::dvec3 first = forward + step * ((0.5 - kWidth / 2.) * right - (0.5 - kHeight / 2.) * up);
  glm::dvec3 parts[] = {first, step * right, -step * up};
  for (int i = 0; i < 3; ++i)
    for (glm::ivec4& limb : picture.limbs[i]) {
      parts[i] *= 0x1p18;
      limb = glm::ivec4(glm::floor(parts[i]), 0);
      parts[i] -= glm::floor(parts[i]);
    }
  return picture;
}

// The file, then its tables, in as many buffers as they need.
std::vector<Compute::Buffer> upload(const Compute& gpu, const svdag::DagFile& file) {
  std::vector<uint32_t> words(file.bytes().size() / 4);
  std::memcpy(words.data(), file.bytes().data(), file.bytes().size());
  const std::vector<uint32_t> tables = gpu_tables(file);
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
  picture.eye.w = int32_t(file.bytes().size() / 4);
  picture.size.z = !file.layers().layers.empty();
  picture.size.w = file.has_colours();

  const Compute gpu;
  const auto buffers = upload(gpu, file);
  const uint32_t count = buffers.size() == 1 ? 1 : SVDAG_BUFFERS;  // one buffer needs no switch
  const size_t pixels = kWidth * kHeight;
  const Compute::Buffer output = gpu.storage(sizeof(Picture) + pixels * sizeof(Pixel));
  std::memcpy(output.data, &picture, sizeof picture);
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
