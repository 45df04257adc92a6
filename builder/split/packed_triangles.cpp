#include "builder/split/packed_triangles.h"

namespace svdag {

// Vertices differ by less than 2^63 (builder/overlap/triangle_setup.h), so no difference overflows.
void PackedTriangles::push_back(const LatticeTriangle& triangle) {
  Record record{};
  bool small = triangle.subject <= UINT16_MAX && triangle.cut == 0;
  for (size_t a = 0; a < 3; ++a) {
    const int64_t q = triangle.v[0][int(a)];
    record.low[a] = uint32_t(q);
    record.high[a] = int8_t(q >> 32);
    small &= q >> 32 == record.high[a];
    for (size_t i = 0; i < 2; ++i) {
      const int64_t difference = triangle.v[i + 1][int(a)] - q;
      record.to_others[i][a] = int32_t(difference);
      small &= difference == record.to_others[i][a];
    }
  }
  record.subject = uint16_t(triangle.subject);
  record.sheet = uint8_t(triangle.sheet);
  if (!small) {
    record.low[0] = uint32_t(large_.size());
    record.sheet = kLarge;
    large_.push_back(triangle);
  }
  records_.push_back(record);
}

LatticeTriangle PackedTriangles::operator[](uint64_t i) const {
  const Record& record = records_[i];
  if (record.sheet == kLarge) return large_[record.low[0]];
  LatticeTriangle triangle;
  for (size_t a = 0; a < 3; ++a) {
    const int64_t q = int64_t(record.high[a]) * (int64_t(1) << 32) + record.low[a];
    triangle.v[0][int(a)] = q;
    for (size_t k = 0; k < 2; ++k) triangle.v[k + 1][int(a)] = q + record.to_others[k][a];
  }
  triangle.subject = record.subject;
  triangle.sheet = record.sheet & kSheets;
  return triangle;
}

}  // namespace svdag
