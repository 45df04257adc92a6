#include "io/scene/mesh/vertex_windows.h"

#include <algorithm>
#include <bit>

#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// A writer or a reader of a stream holds two.
constexpr uint64_t kBlocksPerStream = 2;

}  // namespace

SpillFile* open_spill(const SpillSpace& space) {
  SpillFile* const file = space.file();
  if (space.share < 8 * kBlocksPerStream * file->block_bytes())
    throw Error(ExitCode::kMemory,
                "the memory budget is too small to spill the vertices of a mesh: raise --memory");
  return file;
}

OwnedStream& OwnedStream::operator=(OwnedStream&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(stream_, other.stream_);
  return *this;
}

OwnedStream::~OwnedStream() {
  if (file_ != nullptr) file_->free(stream_);
}

void fail_changed() {
  throw Error(ExitCode::kBadInput, "a scene file changed while it was being read");
}

// The largest windows that leave memory for the references and the answers: large windows mean few
// streams.
VertexWindows::VertexWindows(const SpillSpace& space, MemoryBudget* budget, bool single)
    : file_(open_spill(space)),
      new_number_(space.stream_number),
      budget_(budget),
      single_(single),
      position_bytes_(3 * (single ? sizeof(float) : sizeof(double))) {
  const uint64_t stream_bytes = kBlocksPerStream * file_->block_bytes();
  // References are 32 bits.
  const uint64_t fit = (space.share - 2 * stream_bytes) / position_bytes_;
  shift_ = std::min(int(std::bit_width(fit)) - 1, 32);
  max_windows_ =
      space.share / stream_bytes - 2;  // one for positions, one for what the caller keeps
}

void VertexWindows::add(std::span<const std::byte> positions) {
  check_interrupt();
  while (!positions.empty()) {
    const uint64_t room = window() - (size_ & (window() - 1));
    const uint64_t n = std::min(room, positions.size() / position_bytes_);
    if (!positions_out_) {
      if (positions_.size() == max_windows_)
        throw Error(ExitCode::kMemory,
                    "a mesh of more than " + std::to_string(size_) +
                        " vertices does not fit the memory budget: raise --memory");
      positions_out_.emplace(new_stream());
    }
    positions_out_->append(positions.first(size_t(n * position_bytes_)));
    positions = positions.subspan(size_t(n * position_bytes_));
    size_ += n;
    if (n == room) finish_window();
  }
}

void VertexWindows::finish_window() {
  if (!positions_out_) return;
  positions_.emplace_back(file_, positions_out_->finish());
  positions_out_.reset();
}

void VertexWindows::open_references(uint64_t w) {
  if (w >= references_.size()) references_.resize(size_t(w) + 1);
  references_[size_t(w)].emplace(new_stream());
}

void VertexWindows::join() {
  finish_window();
  std::vector<OwnedStream> references(positions_.size());
  for (size_t w = 0; w < references_.size(); ++w) {
    if (references_[w]) references[w] = OwnedStream(file_, references_[w]->finish());
    references_[w].reset();
  }
  const uint64_t bytes = std::min(window(), size_) * position_bytes_;
  const auto memory = budget_->reserve(bytes, "vertex positions");
  const auto loaded = std::make_unique_for_overwrite<std::byte[]>(size_t(bytes));
  answers_.resize(positions_.size());
  for (size_t w = 0; w < positions_.size(); ++w) {
    const OwnedStream positions = std::move(positions_[w]),
                      references_of_window = std::move(references[w]);
    if (references_of_window.empty()) continue;
    load(positions, loaded.get());
    answers_[w] = single_ ? answer<float>(references_of_window, loaded.get())
                          : answer<double>(references_of_window, loaded.get());
  }
}

void VertexWindows::load(const OwnedStream& positions, std::byte* to) const {
  SpillReader reader = positions.read(budget_);
  for (auto block = reader.next(); !block.empty(); block = reader.next())
    to = std::copy(block.begin(), block.end(), to);
}

template <class T>
OwnedStream VertexWindows::answer(const OwnedStream& references, const std::byte* positions) {
  using Position = std::array<T, 3>;
  std::array<Position, 256> batch;  // passed to the writer in one call
  SpillReader reader = references.read(budget_);
  SpillWriter writer = new_stream();
  for (auto block = reader.next(); !block.empty(); block = reader.next()) {
    check_interrupt();
    const std::span<const uint32_t> references_of_window(
        reinterpret_cast<const uint32_t*>(block.data()), block.size() / sizeof(uint32_t));
    for (size_t done = 0; done < references_of_window.size();) {
      const size_t n = std::min(batch.size(), references_of_window.size() - done);
      for (size_t k = 0; k < n; ++k)
        std::memcpy(&batch[k], positions + references_of_window[done + k] * sizeof(Position),
                    sizeof(Position));
      writer.append(std::as_bytes(std::span(batch).first(n)));
      done += n;
    }
  }
  return OwnedStream(file_, writer.finish());
}

void VertexWindows::rewind() {
  replay_.clear();
  replay_.resize(answers_.size());
}

// A position that crosses the end of the block.
Point VertexWindows::next_beyond(Cursor& from, const OwnedStream& stream) {
  if (!from.reader && !stream.empty()) from.reader.emplace(stream.read(budget_));
  std::array<std::byte, 3 * sizeof(double)> position;
  for (size_t done = 0; done < position_bytes_;) {
    if (from.here == from.end) {
      check_interrupt();
      const auto block = from.reader ? from.reader->next() : std::span<std::byte>();
      if (block.empty()) fail_changed();
      from.here = block.data();
      from.end = from.here + block.size();
    }
    const size_t n = std::min(position_bytes_ - done, size_t(from.end - from.here));
    std::memcpy(position.data() + done, from.here, n);
    from.here += n;
    done += n;
  }
  return point_at(position.data());
}

}  // namespace svdag
