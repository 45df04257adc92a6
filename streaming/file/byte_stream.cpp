#include "streaming/file/byte_stream.h"

#include <algorithm>
#include <cstring>

#include "streaming/error.h"

namespace svdag {

ByteStream::ByteStream(const File& file, uint64_t begin, uint64_t end, size_t window)
    : file_(&file),
      end_(std::min(end, file.size())),
      base_(std::min(begin, end_)),
      window_(size_t(std::clamp<uint64_t>(end_ - base_, 1, window))) {}

void ByteStream::fill(size_t min_bytes) {
  const size_t kept = filled_ - position_;
  std::memmove(window_.data(), window_.data() + position_, kept);
  base_ += position_;
  position_ = 0;
  filled_ = kept;
  if (window_.size() < min_bytes) window_.resize(std::max(min_bytes, 2 * window_.size()));
  const uint64_t missing = std::min<uint64_t>(window_.size() - kept, end_ - (base_ + kept));
  filled_ += file_->read_some_at(base_ + kept, std::span(window_).subspan(kept, missing));
  if (filled_ < kept + missing) end_ = base_ + filled_;  // the file was truncated meanwhile
}

std::span<const std::byte> ByteStream::peek(size_t min_bytes) {
  const size_t required = size_t(std::min<uint64_t>(min_bytes, remaining()));
  if (filled_ - position_ < required) fill(required);
  return std::span(window_).subspan(position_, filled_ - position_);
}

void ByteStream::skip(uint64_t n) {
  if (n > remaining()) fail_input(file_->path(), "ends too early", end_);
  if (n <= filled_ - position_) {
    position_ += size_t(n);
    return;
  }
  base_ = offset() + n;
  position_ = filled_ = 0;
}

void ByteStream::read(std::span<std::byte> out) {
  if (out.size() > remaining()) fail_input(file_->path(), "ends too early", end_);
  size_t done = 0;
  while (done < out.size()) {
    const auto bytes = peek(1);
    if (bytes.empty()) fail_input(file_->path(), "ends too early", end_);
    const size_t n = std::min(bytes.size(), out.size() - done);
    std::memcpy(out.data() + done, bytes.data(), n);
    position_ += n;
    done += n;
  }
}

std::optional<std::string_view> ByteStream::line(size_t max_bytes) {
  size_t seen = 0;
  for (size_t required = 1;; required = seen + 1) {
    const auto bytes = peek(required);
    if (bytes.empty()) return {};
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t end = text.find_first_of("\n\r", seen);
    if (end == std::string_view::npos) {
      seen = text.size();
      if (seen > max_bytes) fail_input(file_->path(), "has a line that is too long", offset());
      if (seen < remaining()) continue;
      position_ += seen;
      return text;
    }
    // A "\r" at the very end of the window may be the first half of "\r\n".
    if (text[end] == '\r' && end + 1 == text.size() && end + 1 < remaining()) {
      seen = end;
      peek(end + 2);
      required = end + 2;
      continue;
    }
    const bool pair = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
    position_ += end + (pair ? 2 : 1);
    return text.substr(0, end);
  }
}

}  // namespace svdag
