#include "io/scene/gltf/document/gltf_uri.h"

#include <unistd.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <sstream>

#include "streaming/error.h"
#include "streaming/file/file_folder.h"

namespace svdag {
namespace {

// A URI may be a megabyte: errors show its beginning.
std::string shown(std::string_view uri) {
  return "\"" + std::string(uri.substr(0, 60)) + (uri.size() > 60 ? "...\"" : "\"");
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decode(std::string_view uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    const bool is_escape = high >= 0 && low >= 0;  // Blender before 3.5 wrote bare ones
    text += is_escape ? char(high * 16 + low) : '%';
    i += is_escape ? 2 : 0;
  }
  return text;
}

bool has_scheme(const std::string& text) {
  const size_t colon = text.find(':');
  return colon != std::string::npos && text.find('/') > colon;
}

bool has_parent_part(const std::string& text) {
  std::istringstream parts(text);
  parts.exceptions(std::ios::badbit);  // a lack of memory must not shorten the path
  for (std::string part; std::getline(parts, part, '/');) {
    if (part == "..") return true;
  }
  return false;
}

constexpr std::array<int8_t, 256> base64_values() {
  std::array<int8_t, 256> values{};
  for (int8_t& v : values) v = -1;
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < kDigits.size(); ++i) values[size_t(kDigits[i])] = int8_t(i);
  return values;
}

}  // namespace

std::vector<std::byte> decode_data_uri(std::string_view uri, const std::string& path) {
  static constexpr std::array<int8_t, 256> kValues = base64_values();
  constexpr std::string_view kMark = ";base64,";
  const size_t mark = uri.find(kMark);
  if (mark == std::string_view::npos) {
    fail_input(path, "has a data URI that is not base64: " + shown(uri));
  }
  std::string_view text = uri.substr(mark + kMark.size());
  while (text.ends_with('=')) text.remove_suffix(1);
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const int value = kValues[static_cast<unsigned char>(text[i])];
    if (value < 0) fail_input(path, "has a data URI with a character that is not base64");
    bits = bits << 6 | uint32_t(value);
    // Digits 1, 2, 3 of each group of four complete a byte.
    if (i % 4 != 0) bytes.push_back(std::byte(bits >> (6 - 2 * (i % 4))));
  }
  return bytes;
}

File open_beside(const std::string& scene_path, std::string_view uri, const std::string& kind) {
  const std::string text = percent_decode(uri);
  const std::string refers = "refers to the " + kind + " " + shown(uri);
  const bool leaves = text.empty() || text.front() == '/' || has_scheme(text) ||
                      has_parent_part(text) || text.find('\0') != std::string::npos;
  if (leaves) {
    fail_input(scene_path, refers + ", but it must be a file in the scene's folder");
  }
  const std::string target = folder_of(scene_path) + "/" + text;
  if (::access(target.c_str(), F_OK) != 0)
    fail_input(scene_path, refers + ", which does not exist");
  if (!is_inside(folder_of(scene_path), target))
    fail_input(scene_path, refers + ", a link that leads out of the scene's folder");
  return File::open_read(target);
}

}  // namespace svdag
