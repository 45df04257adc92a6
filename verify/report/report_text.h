// Formats text for the report's page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace svdag {

// Replaces & < > and " by HTML entities.
std::string escaped(const std::string& text);
// 104807909 -> "105 M": K, M, G and T are powers of 1000.
std::string short_count(uint64_t count);
// Bytes in base 64 (RFC 4648, with padding).
std::string base64(std::span<const std::byte> bytes);

}  // namespace svdag
