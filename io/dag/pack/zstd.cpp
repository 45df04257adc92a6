#include "io/dag/pack/zstd.h"

#include <zstd.h>

#include <string>

#include "streaming/error.h"

namespace svdag {

size_t append_zstd(std::span<const unsigned char> bytes, int level, std::vector<std::byte>* out) {
  const size_t begin = out->size(), bound = ZSTD_compressBound(bytes.size());
  out->resize(begin + bound);
  const size_t size = ZSTD_compress(out->data() + begin, bound, bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size) != 0)
    throw Error(ExitCode::kMemory, std::string("zstd: ") + ZSTD_getErrorName(size));
  out->resize(begin + size);
  return size;
}

ZstdDecoder::ZstdDecoder() : context_(ZSTD_createDCtx()) {
  if (!context_) throw Error(ExitCode::kMemory, "zstd: out of memory");
}

bool ZstdDecoder::decode(std::span<const std::byte> frame, std::span<unsigned char> out) {
  const size_t size =
      ZSTD_decompressDCtx(context_.get(), out.data(), out.size(), frame.data(), frame.size());
  return ZSTD_isError(size) == 0 && size == out.size();
}

void ZstdDecoder::Free::operator()(ZSTD_DCtx_s* context) const {
  ZSTD_freeDCtx(context);
}

}  // namespace svdag
