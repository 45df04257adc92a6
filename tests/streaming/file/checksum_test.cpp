#include "streaming/file/checksum.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "tests/any_of.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

Hash128 hash128(std::string_view text) {
  Hasher128 hasher;
  hasher.update(bytes_of(text));
  return hasher.digest();
}

// Expected values from the Python binding: xxh3_64_hexdigest(text), xxh3_128_hexdigest(text).
TEST(Checksum, KnownAnswers) {
  EXPECT_EQ(checksum64(bytes_of("")), 0x2d06800538d394c2U);
  EXPECT_EQ(checksum64(bytes_of("svdag")), 0xdf60fe86d32bc396U);
  EXPECT_EQ(hash128(""), (Hash128{0x6001c324468d497fU, 0x99aa06d3014798d8U}));
  EXPECT_EQ(hash128("svdag"), (Hash128{0x2dc0b8d6d5e2637eU, 0xeaed6f81363823e1U}));
}

RC_GTEST_PROP(Checksum, PiecesHashLikeTheWhole, (const std::string& a, const std::string& b)) {
  Hasher128 hasher;
  hasher.update(bytes_of(a));
  hasher.update(bytes_of(b));
  RC_ASSERT(hasher.digest() == hash128(a + b));
}

RC_GTEST_PROP(Checksum, OneFlippedBitChangesBoth, ()) {
  auto text = *rc::gen::nonEmpty<std::string>();
  const uint64_t before64 = checksum64(bytes_of(text));
  const Hash128 before128 = hash128(text);
  text[*any_of<size_t>(0, text.size())] ^= char(1 << *any_of(0, 8));
  RC_ASSERT(checksum64(bytes_of(text)) != before64);
  RC_ASSERT(hash128(text) != before128);
}

}  // namespace
}  // namespace svdag
