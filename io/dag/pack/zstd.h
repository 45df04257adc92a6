// zstd, behind a narrow header.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

struct ZSTD_DCtx_s;

namespace svdag {

// Appends a zstd frame of `bytes` to *out and returns its size. Error: kMemory.
size_t append_zstd(std::span<const unsigned char> bytes, int level, std::vector<std::byte>* out);

// Decodes frames, on one thread. Its memory serves for all: a new one for each frame would take a
// sixth of the time of unpacking.
class ZstdDecoder {
 public:
  // Error: kMemory.
  ZstdDecoder();

  // Decodes one frame to exactly out.size() bytes; false if it is invalid or has another size.
  bool decode(std::span<const std::byte> frame, std::span<unsigned char> out);

 private:
  struct Free {
    void operator()(ZSTD_DCtx_s* context) const;
  };
  std::unique_ptr<ZSTD_DCtx_s, Free> context_;
};

}  // namespace svdag
