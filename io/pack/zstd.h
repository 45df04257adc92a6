// zstd, behind a narrow header.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace svdag {

// Appends a zstd frame of `bytes` to *out and returns its size. Error: kMemory.
size_t append_zstd(std::span<const unsigned char> bytes, int level, std::vector<std::byte>* out);

// Decodes one frame to exactly out.size() bytes; false if it is invalid or has another size.
bool decode_zstd(std::span<const std::byte> frame, std::span<unsigned char> out);

}  // namespace svdag
