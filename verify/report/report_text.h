// Formats text for the report's page.
#pragma once

#include <cstdint>
#include <string>

namespace svdag {

// Replaces & < > and " by HTML entities.
std::string escaped(const std::string& text);
// Formats a number by a printf pattern.
std::string formatted(const char* pattern, double value);
// 104807909 -> "105 M": K, M, G and T are powers of 1000.
std::string short_count(uint64_t count);

}  // namespace svdag
