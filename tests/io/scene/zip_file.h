// Zip archives for tests, written from the specification alone, without compression.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace svdag {

inline std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  const auto little = [](uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += char(value >> 8 * i);
    return text;
  };
  std::string archive, directory;
  for (const auto& [name, bytes] : files) {
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), uInt(bytes.size()));
    // Version, flags, method, time, date.
    const std::string about = little(20, 2) + std::string(8, '\0') + little(sum, 4) +
                              little(bytes.size(), 4) + little(bytes.size(), 4) +
                              little(name.size(), 2) + little(0, 2);
    directory +=
        "PK\1\2" + little(20, 2) + about + std::string(10, '\0') + little(archive.size(), 4) + name;
    archive += "PK\3\4" + about + name + bytes;
  }
  return archive + directory + "PK\5\6" + std::string(4, '\0') + little(files.size(), 2) +
         little(files.size(), 2) + little(directory.size(), 4) + little(archive.size(), 4) +
         little(0, 2);
}

}  // namespace svdag
