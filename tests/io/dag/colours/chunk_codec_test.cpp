#include "io/dag/colours/chunk_codec.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "io/dag/colours/colours_check.h"
#include "tests/io/dag/colours/colour_rows.h"

namespace svdag {
namespace {

std::vector<uint32_t> encoded(const std::vector<uint32_t>& colours, uint32_t max_squared) {
  std::vector<uint32_t> words;
  ChunkEncoder(max_squared).encode(colours, &words);
  return words;
}

std::vector<uint32_t> decoded(std::vector<uint32_t> words, size_t count) {
  words.push_back(0xa5a5a5a5);  // the next chunk, which may be read
  std::vector<uint32_t> colours(count);
  decode_chunk(words.data(), colours);
  return colours;
}

// Every colour is within the error, a look-up is the sequential decoder's colour, the words are
// valid and come out again.
void expect_good(const std::vector<uint32_t>& colours, uint32_t max_squared) {
  const std::vector<uint32_t> words = encoded(colours, max_squared);
  EXPECT_EQ(chunk_defect(words.data(), words.size(), uint32_t(colours.size())), nullptr);
  const std::vector<uint32_t> result = decoded(words, colours.size());
  std::vector<uint32_t> readable = words;
  readable.push_back(0xa5a5a5a5);  // the next chunk
  for (size_t i = 0; i < colours.size(); ++i) {
    ASSERT_EQ(result[i] == kNoColour, colours[i] == kNoColour) << i;
    if (colours[i] != kNoColour) {
      ASSERT_LE(squared_distance(result[i], colours[i]), int(max_squared)) << i;
    }
    ASSERT_EQ(chunk_colour(readable.data(), uint32_t(i)), result[i]) << i;
  }
  EXPECT_EQ(encoded(colours, max_squared), words);
}

TEST(ChunkCodec, ColoursAreWithinTheErrorAndAreFoundAtRandom) {
  std::mt19937_64 random(1);
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const size_t count = seed < 40 ? 1 + random() % 700 : 1 + random() % kChunkColours;
    for (const uint32_t max_squared : {0U, 81U, 162U, 1000U})
      expect_good(textured(count, seed, seed % 3 == 0), max_squared);
  }
}

TEST(ChunkCodec, ExtremeChunks) {
  for (const uint32_t max_squared : {0U, 81U, 3U * 255 * 255}) {
    expect_good({rgb(1, 2, 3)}, max_squared);
    expect_good({kNoColour}, max_squared);
    expect_good(std::vector<uint32_t>(kChunkColours, rgb(9, 8, 7)), max_squared);
    expect_good(std::vector<uint32_t>(kChunkColours, kNoColour), max_squared);
    expect_good(noise(kChunkColours, 1), max_squared);
    std::vector<uint32_t> alternating(kChunkColours, kNoColour);
    for (size_t i = 0; i < alternating.size(); i += 2) alternating[i] = rgb(int(i & 255), 0, 255);
    expect_good(alternating, max_squared);
  }
}

TEST(ChunkCodec, WithoutErrorColoursComeBack) {
  for (const auto& colours : {noise(5000, 2), textured(16384, 3), textured(3000, 4, true)})
    EXPECT_EQ(decoded(encoded(colours, 0), colours.size()), colours);
}

TEST(ChunkCodec, PlainAreasKeepTheirColourAndTakeAFewBytes) {
  const std::vector<uint32_t> colours(kChunkColours, rgb(99, 122, 128));
  const auto words = encoded(colours, 81);
  EXPECT_EQ(words.size(), 4U);  // a run, its group, its header, its colour
  EXPECT_EQ(decoded(words, colours.size()), colours);
}

TEST(ChunkCodec, WordsAreThoseOfTheFormatsPage) {
  const uint32_t orange = rgb(200, 100, 50);
  EXPECT_EQ(encoded({orange, orange, orange, kNoColour, kNoColour}, 81),
            (std::vector<uint32_t>{2, 0, 0x00380802, 0x003264c8}));
}

// The definition, without windows that slide: the least cost over all runs of every kind.
uint32_t least_cost(const ChunkEncoder& encoder, uint32_t count) {
  std::vector<uint32_t> cost(count + 1, UINT32_MAX);
  cost[0] = 0;
  for (uint32_t end = 1; end <= count; ++end) {
    for (uint32_t kind = 0; kind < kRunKinds; ++kind) {
      for (uint32_t start = encoder.first_start(kind, end); start < end; ++start) {
        const uint32_t length = end - start;
        if (kind == kLongRun ? length % 256 != 0 : length > 256) continue;
        cost[end] = std::min(cost[end], cost[start] + kRunCost + bits_per_run(kind) +
                                            bits_per_colour(kind) * length);
      }
    }
  }
  return cost[count];
}

TEST(ChunkCodec, RunsAreTheCheapest) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    for (const uint32_t max_squared : {0U, 81U, 400U}) {
      const auto colours = textured(1 + seed * 37, seed, seed % 2 == 0);
      ChunkEncoder encoder(max_squared);
      std::vector<uint32_t> words;
      encoder.encode(colours, &words);
      EXPECT_EQ(encoder.cost(), least_cost(encoder, uint32_t(colours.size()))) << seed;
      // The cost is that of the words, but for the number of runs and what is rounded.
      const uint32_t runs = words[0];
      const uint32_t bits = 32 * uint32_t(words.size() - 1) - 32 * chunk_groups(runs) + 2 * runs;
      EXPECT_NEAR(bits, encoder.cost(), 64 + chunk_groups(runs)) << seed;
    }
  }
}

// Against every colour that could be the constant of two: one that rounding moves by less than a
// step is within the error.
TEST(ChunkCodec, ConstantsOfPairsAreFound) {
  std::mt19937_64 random(5);
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const int x = int(random() % 200), y = int(random() % 200);
    const auto near = [&] { return rgb(x + int(random() % 12), y + int(random() % 12), 70); };
    const std::vector<uint32_t> pair{near(), near()};
    const auto has_constant = [&](int max_squared) {
      for (int r = x; r < x + 12; ++r)
        for (int g = y; g < y + 12; ++g)
          if (squared_distance(rgb(r, g, 70), pair[0]) <= max_squared &&
              squared_distance(rgb(r, g, 70), pair[1]) <= max_squared)
            return true;
      return false;
    };
    ChunkEncoder encoder(25);
    std::vector<uint32_t> words;
    encoder.encode(pair, &words);
    const bool is_found = encoder.first_start(kConstantRun, 2) == 0;
    found += is_found;
    EXPECT_TRUE(is_found ? has_constant(25) : !has_constant(16));
  }
  EXPECT_GT(found, 100);
}

TEST(ChunkCodec, ChannelsOfLinesAreRoundedQuotients) {
  for (const uint32_t last : {1U, 3U, 7U, 15U})
    for (uint32_t a = 0; a < 256; ++a)
      for (uint32_t b = 0; b < 256; ++b)
        for (uint32_t w = 0; w <= last; ++w)
          ASSERT_EQ(line_channel(a, b, w, last), (a * (last - w) + b * w + last / 2) / last);
}

// A chunk that passes the check is safe to read, whatever its bits are.
TEST(ChunkCodec, DamagedChunksAreFoundOrHarmless) {
  std::mt19937_64 random(7);
  size_t found = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const auto colours = textured(1 + random() % 3000, seed, true);
    const auto good = encoded(colours, 81);
    for (int i = 0; i < 200; ++i) {
      auto words = good;
      if (random() % 8 == 0) words.resize(random() % (words.size() + 2));
      if (!words.empty())
        words[random() % std::min<size_t>(words.size(), 40)] ^= 1U << random() % 32;
      const uint32_t count = uint32_t(colours.size()) + (random() % 8 == 0);
      if (chunk_defect(words.data(), words.size(), count) != nullptr) {
        ++found;
        continue;
      }
      const auto all = decoded(words, count);
      words.push_back(0);
      for (uint32_t k = 0; k < count; k += 7) ASSERT_EQ(chunk_colour(words.data(), k), all[k]);
    }
  }
  EXPECT_GT(found, 1000U);
}

}  // namespace
}  // namespace svdag
