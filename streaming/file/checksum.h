// Checksums of the formats: XXH3 of 64 and 128 bits (xxHash), little-endian as stored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace svdag {

using Hash128 = std::array<uint64_t, 2>;  // low word, high word of XXH128_hash_t

// 32 hex digits, the high word first: how a hash is shown to people.
std::string to_hex(const Hash128& hash);
// The same of a hash in a file's header.
inline std::string to_hex(const uint64_t (&hash)[2]) {
  return to_hex(Hash128{hash[0], hash[1]});
}

uint64_t checksum64(std::span<const std::byte> bytes);

// XXH3-128 over a sequence of byte ranges.
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
