#include "io/scene/decoders/gzip.h"

#include <zlib.h>

#include <array>
#include <memory>
#include <vector>

#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kOutput = size_t(1) << 18;
constexpr size_t kStart = size_t(1) << 16;  // holds any usual header and the first codes
constexpr int kGzipOnly = 16;               // added to the window bits

class Inflater {
 public:
  Inflater() {
    if (inflateInit2(&state_, MAX_WBITS + kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&state_); }
  Inflater(const Inflater&) = delete;

  // Inflates the first bytes.
  size_t unpack_start(std::span<std::byte> bytes, std::span<std::byte> out) {
    state_.next_in = reinterpret_cast<Bytef*>(bytes.data());
    state_.avail_in = uInt(bytes.size());
    state_.next_out = reinterpret_cast<Bytef*>(out.data());
    state_.avail_out = uInt(out.size());
    const int result = inflate(&state_, Z_SYNC_FLUSH);
    return result == Z_OK || result == Z_STREAM_END ? out.size() - state_.avail_out : 0;
  }

  // Inflates a member of the file from the stream's position on, and appends it to `out`.
  void unpack_member(ByteStream* stream, File* out, uint64_t* size, const UnpackRoom& room) {
    inflateReset(&state_);
    for (int result = Z_OK; result != Z_STREAM_END;) {
      check_interrupt();
      const auto bytes = stream->peek();
      if (bytes.empty()) fail_input(stream->file().path(), "ends too early", stream->offset());
      // zlib does not write to its input.
      state_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
      state_.avail_in = uInt(bytes.size());
      do {
        state_.next_out = reinterpret_cast<Bytef*>(output_.get());
        state_.avail_out = uInt(kOutput);
        result = inflate(&state_, Z_NO_FLUSH);
        if (result == Z_MEM_ERROR) throw std::bad_alloc();
        if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
          fail_input(stream->file().path(), "is damaged: its gzip data cannot be unpacked",
                     stream->offset() + bytes.size() - state_.avail_in);
        const size_t count = kOutput - state_.avail_out;
        if (count > room.max_bytes - *size)
          throw Error(ExitCode::kOutput,
                      "has no room for the content of " + stream->file().path() +
                          ", which is more than " + format_bytes(room.max_bytes) +
                          ": give another folder by --scratch or TMPDIR",
                      room.folder);
        out->write_at(*size, {output_.get(), count});
        *size += count;
      } while (state_.avail_out == 0 && result != Z_STREAM_END);
      stream->skip(bytes.size() - state_.avail_in);
    }
  }

 private:
  z_stream state_{};
  std::unique_ptr<std::byte[]> output_ = std::make_unique_for_overwrite<std::byte[]>(kOutput);
};

bool begins_member(std::span<const std::byte> bytes) {
  return bytes.size() >= 3 && bytes[0] == std::byte(0x1f) && bytes[1] == std::byte(0x8b) &&
         bytes[2] == std::byte(Z_DEFLATED);
}

}  // namespace

bool is_gzip(const File& file) {
  std::array<std::byte, 3> head{};
  return file.read_some_at(0, head) == head.size() && begins_member(head);
}

size_t unpack_start(const File& file, std::span<std::byte> out) {
  std::vector<std::byte> bytes(kStart);
  bytes.resize(file.read_some_at(0, bytes));
  return Inflater().unpack_start(bytes, out);
}

void unpack_gzip(const File& file, File* out, const UnpackRoom& room) {
  ByteStream stream(file);
  Inflater inflater;
  uint64_t size = 0;
  inflater.unpack_member(&stream, out, &size, room);
  // As gzip does: further members are appended, anything else after a member is ignored.
  while (begins_member(stream.peek(3))) inflater.unpack_member(&stream, out, &size, room);
}

}  // namespace svdag
