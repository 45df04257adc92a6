// Checksums of the file formats: XXH3 with 64 and 128 bits (xxHash), stored little-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace svdag {

using Hash128 = std::array<uint64_t, 2>;  // low word, high word of XXH128_hash_t

// 32 lower-case hex digits, high word first: the form in reports.
std::string to_hex(const Hash128& hash);
// The same for a hash in a file header.
inline std::string to_hex(const uint64_t (&hash)[2]) {
  return to_hex(Hash128{hash[0], hash[1]});
}

// XXH3-64, seed 0.
uint64_t checksum64(std::span<const std::byte> bytes);

// XXH3-128.
Hash128 hash128(std::span<const std::byte> bytes, uint64_t seed);

// XXH3-128, seed 0, of the concatenation of byte ranges.
class Hasher128 {
 public:
  Hasher128();
  ~Hasher128();
  void update(std::span<const std::byte> bytes);
  Hash128 digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace svdag
