// The protocol of all third-party decoders: they run in a limited child
// (streaming/process/limited_child.h) and send back what they decoded as messages.
//
// A message is a kind, which decoder and receiver agree on, and records: values of one type that
// have no pointers. Long arrays become several messages; short messages share a block of the pipe.
// The receiver checks sizes and kinds; what the records say is untrusted and checked by the caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "streaming/memory/memory_budget.h"
#include "streaming/process/limited_child.h"

namespace svdag {

// In a block, before the bytes of each message; these are padded to a multiple of 8.
struct MessageHead {
  uint64_t kind = 0, bytes = 0;
};

// In the child.
class DecoderOutput {
 public:
  explicit DecoderOutput(const BlockSink& send) : send_(send) {}

  template <class T>
  void send(uint64_t kind, std::span<const T> records) {
    static_assert(std::is_trivially_copyable_v<T>);
    constexpr size_t kMax = (kChildBlock - sizeof(MessageHead)) / sizeof(T);
    while (records.size() > kMax) {
      send_bytes(kind, std::as_bytes(records.first(kMax)));
      records = records.subspan(kMax);
    }
    send_bytes(kind, std::as_bytes(records));
  }
  template <class T>
  void send_one(uint64_t kind, const T& record) {
    send(kind, std::span(&record, 1));
  }
  void send_text(uint64_t kind, const std::string& text) {
    send(kind, std::span<const char>(text));
  }

  // Sends what is left.
  void flush();

 private:
  void send_bytes(uint64_t kind, std::span<const std::byte> bytes);

  const BlockSink& send_;
  std::vector<std::byte> block_;
};

// A message in the parent, valid during the call.
class DecoderMessage {
 public:
  // Takes the first message off a block.
  DecoderMessage(std::span<const std::byte>* block, const std::string& path);

  uint64_t kind() const { return kind_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  // A message that ends within a record is an Error (kBadInput).
  template <class T>
  std::span<const T> records() const {
    if (bytes_.size() % sizeof(T) != 0) fail();
    return {reinterpret_cast<const T*>(bytes_.data()), bytes_.size() / sizeof(T)};
  }
  template <class T>
  T record() const {
    if (bytes_.size() != sizeof(T)) fail();
    T record;
    std::memcpy(&record, bytes_.data(), sizeof record);
    return record;
  }
  std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }
  // Error (kBadInput): the decoder does not keep to the protocol.
  [[noreturn]] void fail() const;

 private:
  std::span<const std::byte> bytes_;
  uint64_t kind_ = 0;
  const std::string& path_;
};

struct DecoderLimits {
  uint64_t memory = 0;   // in bytes
  uint64_t seconds = 0;  // of processor time
  // The memory budget is what limits `memory`, so a larger one may be enough.
  bool by_budget = false;
};

// For `bytes` of compressed data: the memory that the budget has left and 64 MiB, but at most
// `max_memory`; and a second for every 64 KiB (Draco decodes ten times as much in one).
DecoderLimits decoder_limits(uint64_t bytes, const MemoryBudget& budget,
                             uint64_t max_memory = std::numeric_limits<uint64_t>::max());

// Runs decode() in a limited child and passes its messages to receive(), in order. `sandbox`: with
// a system call filter. `path`: of the scene, for an Error. Errors are those of run_limited(); too
// little memory is kMemory if limits.by_budget, else kBadInput.
void run_decoder(const DecoderLimits& limits, const std::string& path, bool sandbox,
                 const std::function<void(DecoderOutput&)>& decode,
                 const std::function<void(const DecoderMessage&)>& receive);

}  // namespace svdag
