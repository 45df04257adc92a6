// Converts values to bytes and back, for records that only the same machine reads again.
//
// Trivially copyable values are stored as in memory; vectors and strings as their length u64 and
// their elements. Records have checksums where they are stored, so an invalid one is forged or has
// another layout: an Error that names its file, thrown before memory is allocated for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "streaming/error.h"

namespace svdag {

// A type without padding bytes, whose content would be undefined: equal values give equal records.
template <class T>
concept Recordable = std::is_trivially_copyable_v<T> &&
    (std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);

class RecordWriter {
 public:
  template <Recordable T>
  void put(const T& value) {
    append(&value, sizeof value);
  }
  template <Recordable T>
  void put(const std::vector<T>& values) {
    put_list(std::as_bytes(std::span(values)), values.size());
  }
  void put(const std::string& text) { put_list(std::as_bytes(std::span(text)), text.size()); }

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  void put_list(std::span<const std::byte> bytes, uint64_t count) {
    put(count);
    append(bytes.data(), bytes.size());
  }
  void append(const void* from, size_t size) {
    if (size == 0) return;
    const size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, from, size);
  }

  std::vector<std::byte> bytes_;
};

class RecordReader {
 public:
  // `bytes` must outlive the reader. Errors have `code` and name `path`.
  RecordReader(std::span<const std::byte> bytes, std::string path, ExitCode code)
      : bytes_(bytes), path_(std::move(path)), code_(code) {}

  // Throws Error "PATH: is damaged: SENTENCE" unless `condition`.
  void require(bool condition, const char* sentence) const {
    if (!condition) throw Error(code_, std::string("is damaged: ") + sentence, path_);
  }
  // Throws unless all bytes have been read.
  void finish() const { require(bytes_.empty(), "a record is too long"); }

  template <Recordable T>
  void get(T* value) {
    std::memcpy(value, take(sizeof *value), sizeof *value);
  }
  template <Recordable T>
  void get(std::vector<T>* values) {
    uint64_t count = 0;
    get(&count);
    require(count <= bytes_.size() / sizeof(T), kTooShort);
    values->resize(count);
    const std::byte* from = take(count * sizeof(T));
    if (count != 0) std::memcpy(values->data(), from, count * sizeof(T));
  }
  void get(std::string* text) {
    std::vector<char> characters;
    get(&characters);
    text->assign(characters.begin(), characters.end());
  }

 private:
  static constexpr const char* kTooShort = "a record ends too early";

  const std::byte* take(size_t n) {
    require(n <= bytes_.size(), kTooShort);
    const std::byte* at = bytes_.data();
    bytes_ = bytes_.subspan(n);
    return at;
  }

  std::span<const std::byte> bytes_;
  std::string path_;
  ExitCode code_;
};

}  // namespace svdag
