// The vertices and polygons of a mesh on their way from a decoder in a limited child to a
// MeshWriter.
#pragma once

#include <algorithm>
#include <deque>
#include <span>
#include <vector>

#include "io/scene/decoders/limited_decoder.h"
#include "io/scene/polygons/mesh_writer.h"
#include "io/scene/readers/painted_corner.h"

namespace svdag {

// Messages: all vertices, then the polygons, each its number of corners and the corners; of painted
// polygons before them as many PaintedCorners. Decoders number their other messages from
// kOtherMessage on.
enum DecodedMesh : uint64_t { kVertices, kPaintedCorners, kPolygons, kOtherMessage };

// In the child.
class DecodedMeshSender {
 public:
  explicit DecodedMeshSender(DecoderOutput* out) : out_(*out) {}

  void vertex(const Point& p) {
    vertices_.push_back(p);
    if (vertices_.size() == kBatch) send_vertices();
  }
  // Every vertex was sent.
  void polygon(std::span<const uint32_t> corners, std::span<const PaintedCorner> paint = {}) {
    send_vertices();
    paint_.insert(paint_.end(), paint.begin(), paint.end());
    polygons_.push_back(uint32_t(corners.size()));
    polygons_.insert(polygons_.end(), corners.begin(), corners.end());
    if (polygons_.size() >= 4 * kBatch) finish();
  }
  void finish() {
    send_vertices();
    if (!paint_.empty()) out_.send(kPaintedCorners, std::span<const PaintedCorner>(paint_));
    paint_.clear();
    if (!polygons_.empty()) out_.send(kPolygons, std::span<const uint32_t>(polygons_));
    polygons_.clear();
  }

 private:
  static constexpr size_t kBatch = 4096;

  void send_vertices() {
    if (!vertices_.empty()) out_.send(kVertices, std::span<const Point>(vertices_));
    vertices_.clear();
  }

  DecoderOutput& out_;
  std::vector<Point> vertices_;
  std::vector<PaintedCorner> paint_;  // of polygons_, if they are painted
  std::vector<uint32_t> polygons_;
};

// In the parent.
class DecodedMeshReceiver {
 public:
  explicit DecodedMeshReceiver(MeshWriter* out) : out_(*out) {}

  // Of the polygons from here on, which come with PaintedCorners; null: nothing paints them.
  void paint(const Paint* paint) {
    paint_ = paint;
    out_.paint(paint);
    corners_.clear();
  }

  // The next mesh, of at most `max_vertices` vertices.
  void begin(uint64_t max_vertices) {
    max_vertices_ = max_vertices;
    left_ = 0;
    out_.begin(MeshWriter::Precision::kDouble, max_vertices);
  }
  void receive(const DecoderMessage& message) {
    if (message.kind() == kVertices) {
      const auto vertices = message.records<Point>();
      if (vertices.size() > max_vertices_ - out_.vertices()) message.fail();
      for (const Point& p : vertices) out_.vertex(p);
    } else if (message.kind() == kPaintedCorners && paint_ != nullptr && left_ == 0) {
      const auto corners = message.records<PaintedCorner>();
      corners_.insert(corners_.end(), corners.begin(), corners.end());
    } else if (message.kind() == kPolygons) {
      for (const uint32_t word : message.records<uint32_t>()) receive_word(message, word);
    } else {
      message.fail();
    }
  }

 private:
  void receive_word(const DecoderMessage& message, uint32_t word) {
    if (left_ == 0) {
      left_ = word;
      return;
    }
    if (word >= out_.vertices()) message.fail();
    if (paint_ == nullptr) {
      out_.corner(word);
    } else {
      if (corners_.empty()) message.fail();
      out_.corner(word, place(corners_.front()), corners_.front().colour);
      corners_.pop_front();
    }
    if (--left_ == 0) out_.end_polygon();
  }
  TexturePoint place(const PaintedCorner& corner) const {
    if (!paint_->image) return {0, 0};
    return {corner.u * double(paint_->image->width()), corner.v * double(paint_->image->height())};
  }

  MeshWriter& out_;
  uint64_t max_vertices_ = 0;
  uint32_t left_ = 0;  // corners of the current polygon that have not arrived
  const Paint* paint_ = nullptr;
  std::deque<PaintedCorner> corners_;  // of polygons that have not arrived
};

}  // namespace svdag
