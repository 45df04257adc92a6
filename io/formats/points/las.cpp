// LAS (ASPRS LAS 1.0 to 1.4 R15): a header, and records of a fixed length whose first 12 bytes are
// three 32-bit integers.
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "io/formats/points/point_files.h"
#include "io/values/endian.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {
namespace {

constexpr size_t kLasHeaderBytes = 227;    // of versions 1.0 to 1.2
constexpr size_t kLasHeaderBytes14 = 375;  // of version 1.4
constexpr uint8_t kCompressed = 0x80;      // of the number of the point format: LAZ
constexpr size_t kWithoutColour = 0;

// Of each point format: the bytes of its record, and where its colour is.
struct RecordFormat {
  size_t bytes, colour;
};
constexpr std::array<RecordFormat, 11> kRecordFormats = {{{20, kWithoutColour},
                                                          {28, kWithoutColour},
                                                          {26, 20},
                                                          {34, 28},
                                                          {57, kWithoutColour},
                                                          {63, 28},
                                                          {30, kWithoutColour},
                                                          {36, 30},
                                                          {38, 30},
                                                          {59, kWithoutColour},
                                                          {67, 30}}};

struct LasHeader {
  uint8_t minor = 0;   // of version 1.minor
  uint8_t format = 0;  // of the points
  uint64_t count = 0;
  uint64_t begin = 0;  // of the first record
  size_t record_bytes = 0;
  Point scale{1}, offset{0};
};

class LasHeaderReader {
 public:
  explicit LasHeaderReader(const File& file) : file_(file), size_(file.size()) {
    bytes_.resize(std::min<uint64_t>(size_, kLasHeaderBytes14));
    file.read_at(0, bytes_);
  }

  LasHeader read() {
    LasHeader h;
    if (bytes_.size() < kLasHeaderBytes) fail("ends within its header", size_);
    h.minor = at<uint8_t>(25);
    if (at<uint8_t>(24) != 1 || h.minor > 4)
      fail("is LAS " + std::to_string(at<uint8_t>(24)) + "." + std::to_string(h.minor) +
               ": svdag reads LAS 1.0 to 1.4",
           24);
    h.format = at<uint8_t>(104);
    if ((h.format & kCompressed) != 0)
      fail("is compressed (LAZ): decompress it, for example with laszip or pdal translate", 104);
    if (h.format >= kRecordFormats.size())
      fail("has points of format " + std::to_string(h.format) + ": svdag reads formats 0 to 10",
           104);
    h.record_bytes = at<uint16_t>(105);
    if (h.record_bytes < kRecordFormats[h.format].bytes)
      fail("has records of " + std::to_string(h.record_bytes) + " bytes, but points of format " +
               std::to_string(h.format) + " take " + std::to_string(kRecordFormats[h.format].bytes),
           105);
    read_extent(&h);
    for (int a = 0; a < 3; ++a) {
      h.scale[a] = number(131 + 8 * size_t(a), "scale");
      h.offset[a] = number(155 + 8 * size_t(a), "offset");
      if (!(std::abs(h.scale[a]) >= 1 / PointCloud::kMaxMagnitude))
        fail("has a scale of 0, or nearly so", 131 + 8 * size_t(a));
    }
    return h;
  }

 private:
  // Where the records are, and how many.
  void read_extent(LasHeader* h) {
    const uint16_t header_bytes = at<uint16_t>(94);
    h->begin = at<uint32_t>(96);
    const size_t least = h->minor == 4 ? kLasHeaderBytes14 : kLasHeaderBytes;
    if (header_bytes < least || h->begin < header_bytes)
      fail("has an impossible size of its header, or begin of its points", 94);
    if (h->begin > size_) fail("ends before its first point", size_);
    h->count = h->minor == 4 ? at<uint64_t>(247) : at<uint32_t>(107);
    const uint64_t held = (size_ - h->begin) / h->record_bytes;
    if (h->count > held)
      fail("promises " + std::to_string(h->count) + " points, but holds " + std::to_string(held),
           h->minor == 4 ? 247 : 107);
  }

  template <class T>
  T at(size_t offset) const {
    if (offset + sizeof(T) > bytes_.size()) fail("ends within its header", size_);
    return load_little<T>(bytes_.data() + offset);
  }
  double number(size_t offset, const char* name) const {
    const double value = at<double>(offset);
    if (!(std::abs(value) <= PointCloud::kMaxMagnitude))
      fail(std::string("has the ") + name + " " + std::to_string(value), offset);
    return value;
  }
  [[noreturn]] void fail(const std::string& sentence, uint64_t offset) const {
    fail_input(file_.path(), sentence, offset);
  }

  const File& file_;
  uint64_t size_;
  std::vector<std::byte> bytes_;
};

class LasCloud final : public PointCloud {
 public:
  LasCloud(const File& file, const LasHeader& header) : file_(file), header_(header) {
    scale = header.scale;
    offset = header.offset;
    has_colours = kRecordFormats[header.format].colour != kWithoutColour;
  }

  uint64_t read(const PointSink& sink) const override {
    PointCollector out(sink);
    ByteStream stream(file_, header_.begin);
    for (uint64_t left = header_.count; left > 0;) {
      const auto bytes = stream.peek(header_.record_bytes);
      const uint64_t count = std::min<uint64_t>(bytes.size() / header_.record_bytes, left);
      if (count == 0) fail_input(file_.path(), "ends within a point", stream.offset());
      for (uint64_t i = 0; i < count; ++i) add(bytes.data() + i * header_.record_bytes, &out);
      stream.skip(count * header_.record_bytes);
      left -= count;
    }
    return out.finish();
  }

 private:
  void add(const std::byte* p, PointCollector* out) const {
    const bool is_extended = header_.format >= 6;
    // Version 1.0 has no flags: a number of 8 bits.
    const uint8_t flags = uint8_t(p[15]), plain = header_.minor == 0 ? flags : flags & 31;
    const bool is_withheld =
        is_extended ? (flags & 4) != 0 : header_.minor > 0 && (flags & 128) != 0;
    if (is_withheld) return out->leave_out();
    out->add({load_little<int32_t>(p), load_little<int32_t>(p + 4), load_little<int32_t>(p + 8)});
    out->add_class(is_extended ? uint8_t(p[16]) : plain);
    if (has_colours) {
      const std::byte* const rgb = p + kRecordFormats[header_.format].colour;
      out->add_colour({load_little<uint16_t>(rgb), load_little<uint16_t>(rgb + 2),
                       load_little<uint16_t>(rgb + 4)});
    }
  }

  const File& file_;
  LasHeader header_;
};

}  // namespace

std::unique_ptr<PointCloud> open_las(const File& file) {
  return std::make_unique<LasCloud>(file, LasHeaderReader(file).read());
}

}  // namespace svdag
