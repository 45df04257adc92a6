#include "io/scene/decoders/limited_decoder.h"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr size_t kFullBlock = size_t(1) << 16;  // a block is sent when it has so many bytes

size_t padded(uint64_t bytes) {
  return size_t((bytes + 7) / 8 * 8);
}

}  // namespace

void DecoderOutput::send_bytes(uint64_t kind, std::span<const std::byte> bytes) {
  const MessageHead head = {kind, bytes.size()};
  if (block_.size() + sizeof head + padded(bytes.size()) > kChildBlock) flush();
  const auto of_head = std::as_bytes(std::span(&head, 1));
  block_.insert(block_.end(), of_head.begin(), of_head.end());
  block_.insert(block_.end(), bytes.begin(), bytes.end());
  block_.resize(padded(block_.size()));
  if (block_.size() >= kFullBlock) flush();
}

void DecoderOutput::flush() {
  if (!block_.empty()) send_(block_);
  block_.clear();
}

DecoderMessage::DecoderMessage(std::span<const std::byte>* block, const std::string& path)
    : path_(path) {
  MessageHead head;
  if (block->size() < sizeof head) fail();
  std::memcpy(&head, block->data(), sizeof head);
  *block = block->subspan(sizeof head);
  if (head.bytes > block->size() || padded(head.bytes) > block->size()) fail();
  kind_ = head.kind;
  bytes_ = block->first(size_t(head.bytes));
  *block = block->subspan(padded(head.bytes));
}

void DecoderMessage::fail() const {
  fail_input(path_, "its decoder sent an invalid block");
}

DecoderLimits decoder_limits(uint64_t bytes, const MemoryBudget& budget, uint64_t max_memory) {
  constexpr uint64_t kUnlimited = uint64_t(1) << 40;  // where the budget has no limit
  constexpr uint64_t kBesideBudget = uint64_t(64) << 20;
  const uint64_t left = budget.limit() - std::min(budget.limit(), budget.used());
  const uint64_t memory = kBesideBudget + std::min(left, kUnlimited);
  const bool bounded = max_memory < std::numeric_limits<uint64_t>::max();
  return {std::min(memory, max_memory), 30 + bytes / 65536, bounded && memory < max_memory};
}

void run_decoder(const DecoderLimits& limits, const std::string& path, bool sandbox,
                 const std::function<void(DecoderOutput&)>& decode,
                 const std::function<void(const DecoderMessage&)>& receive) {
  run_limited(
      {limits.memory, limits.seconds, sandbox}, path,
      [&](const BlockSink& send) {
        DecoderOutput out(send);
        try {
          decode(out);
          out.flush();
        } catch (const Error&) {
          out.flush();  // what was decoded before it
          throw;
        } catch (const std::length_error&) {
          throw std::bad_alloc();  // a count that no memory could hold
        } catch (const std::bad_alloc&) {
          if (!limits.by_budget) throw;
          throw Error(ExitCode::kMemory,
                      path + ": its decoder needs more memory than is left: raise --memory");
        }
      },
      [&](std::span<const std::byte> block) {
        while (!block.empty()) receive(DecoderMessage(&block, path));
      });
}

}  // namespace svdag
