#include "streaming/spill/journal.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "streaming/error.h"
#include "streaming/file/checksum.h"

namespace svdag {
namespace {

constexpr size_t kHeader = 16;
constexpr uint64_t kMaxPayload = uint64_t(1) << 30;

using Tag = std::array<uint32_t, 2>;  // kind, length

// The checksum covers tag and payload, but is stored between them: to compute it, the tag is copied
// to the checksum's position, directly before the payload.
uint64_t checksum_of(std::span<std::byte> record, const Tag& tag) {
  std::memcpy(record.data() + 8, tag.data(), 8);
  return checksum64(record.subspan(8));
}

// Returns the record that begins at byte `at`, header included; empty if it is incomplete or
// damaged.
std::vector<std::byte> read_record(const File& file, uint64_t at, uint64_t size) {
  if (size - at < kHeader) return {};
  std::array<std::byte, kHeader> header;
  file.read_at(at, header);
  Tag tag;
  uint64_t checksum;
  std::memcpy(tag.data(), header.data(), 8);
  std::memcpy(&checksum, header.data() + 8, 8);
  if (tag[1] > std::min(kMaxPayload, size - at - kHeader)) return {};
  std::vector<std::byte> record(kHeader + tag[1]);
  file.read_at(at + kHeader, std::span(record).subspan(kHeader));
  if (checksum_of(record, tag) != checksum) return {};
  std::memcpy(record.data(), tag.data(), 8);
  return record;
}

}  // namespace

Journal::Journal(File file, std::vector<JournalRecord>* records) : file_(std::move(file)) {
  records->clear();
  const uint64_t size = file_.size();
  for (;;) {
    const std::vector<std::byte> record = read_record(file_, end_, size);
    if (record.empty()) break;
    uint32_t kind;
    std::memcpy(&kind, record.data(), 4);
    records->push_back({kind, {record.begin() + kHeader, record.end()}});
    end_ += record.size();
  }
  if (end_ < size) file_.truncate(end_);
}

void Journal::append(uint32_t kind, std::span<const std::byte> payload) {
  if (failure_) std::rethrow_exception(failure_);
  try {
    write(kind, payload);
  } catch (...) {
    failure_ = std::current_exception();
    throw;
  }
}

void Journal::write(uint32_t kind, std::span<const std::byte> payload) {
  if (payload.size() > kMaxPayload)
    throw Error(ExitCode::kOutput, "cannot hold a record of more than 2^30 bytes", file_.path());
  const Tag tag = {kind, uint32_t(payload.size())};
  std::vector<std::byte> record(kHeader + payload.size());
  std::copy(payload.begin(), payload.end(), record.begin() + kHeader);
  const uint64_t checksum = checksum_of(record, tag);
  std::memcpy(record.data(), tag.data(), 8);
  std::memcpy(record.data() + 8, &checksum, 8);
  file_.write_at(end_, record);
  file_.sync();
  end_ += record.size();
}

}  // namespace svdag
