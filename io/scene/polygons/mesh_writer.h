// What readers write to: the vertices of a mesh in the order of the file, then (or between them)
// polygons whose corners are numbers of vertices. Only this class looks vertices up and
// triangulates.
//
// Vertices are looked up at once, in memory or, beyond the share that a SpillSpace grants, in pages
// on disk (io/scene/mesh/vertex_pages.h). If the polygons jump between the vertices so much that
// this is costly, the vertices move to windows (io/scene/mesh/vertex_windows.h): from then on the
// corners are recorded, and when the mesh ends a join brings their positions, polygon by polygon in
// the order of the file. The sink gets the same triangles either way. The recording holds for each
// corner the number of its window, in a polygon with a texture its coordinate, and between polygons
// the names that change: so a file is read once.
// Rejected: no recording, but running the reader's loop over the faces again (each reader must be
// written for positions that it cannot see, and text is parsed twice).
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/affine.h"
#include "io/scene/mesh/mesh_reader.h"
#include "io/scene/mesh/positions.h"
#include "io/scene/mesh/vertex_marks.h"
#include "io/scene/polygons/triangulate.h"
#include "streaming/spill/spill_file.h"

namespace svdag {

// Reserved memory for points, kept from one mesh to the next: fresh pages cost more than the
// triangles of a small mesh.
class PointArray {
 public:
  Point* resize(uint64_t count, MemoryBudget* budget);
  void release();
  uint64_t bytes() const { return memory_.bytes(); }

 private:
  MemoryBudget::Reservation memory_;
  std::unique_ptr<Point[]> points_;
  uint64_t capacity_ = 0;
};

class MeshWriter {
 public:
  using Precision = Positions::Precision;

  // `path`: of the scene, for errors. All must outlive the writer.
  MeshWriter(const ReadOptions& options, const std::string& path, const TriangleSink& sink)
      : options_(options), triangulator_(options.budget, path), out_(sink) {}

  // --- Names: of the polygons from here on.

  // Starts the next mesh: triangles are counted from 0 again.
  void mesh(std::string_view name, bool undeformed = false);
  void material(std::string_view name, std::optional<Colour> colour = {});
  // Whether the mesh is the mirror image of another: two corners of each triangle then change
  // places, so that the outside stays outside.
  void mirrored(bool mirrored) { out_.mirrored(mirrored); }
  // The distance of the quantised positions, 0 if they are not.
  void quantisation(double step) {
    is_counted_ |= step != 0;
    out_.quantisation(step);
  }

  // --- Vertices.

  // The vertices that follow replace all earlier ones: at most `max_count`, as float or double.
  // `only_place`: there will be one place() with this transform.
  void begin(Precision precision, uint64_t max_count, const Affine* only_place = nullptr);
  void vertex(const Point& p) {
    if (points_ != nullptr) {
      points_[size_] = to_world_(p);
    } else {
      positions_->add(p);
    }
    ++size_;
  }
  uint64_t vertices() const { return size_; }
  // As begin(), of vertices that are added with their colours, which those of the polygons' points
  // follow from. They are held in memory.
  void begin_coloured(Precision precision, uint64_t max_count);
  void vertex(const Point& p, const VertexColour& colour) {
    vertex(p);
    if (colours_.size() == colours_.capacity()) grow_colours();
    colours_.push_back(colour);
  }

  // Places all vertices, which were added, in the world; `step`: of their quantisation, as stored.
  // Call it before the polygons, for every instance of the mesh. Returns false if these polygons
  // were recorded: they have been drawn again.
  bool place(const Affine& to_world, double step);

  // --- Polygons: corners are numbers below vertices().

  void triangle(uint64_t a, uint64_t b, uint64_t c) {
    if (points_ != nullptr) return out_.add(points_[a], points_[b], points_[c]);
    if (!colours_.empty() || positions_->spilled()) return rare_triangle(a, b, c);
    out_.add(stored(a), stored(b), stored(c));
  }
  void corner(uint64_t i) {
    if (points_ != nullptr) return triangulator_.corner(points_[i]);
    if (!colours_.empty()) return triangulator_.corner(stored(i), colours_[i]);
    if (!positions_->spilled()) return triangulator_.corner(stored(i));
    if (is_recorded()) return record(i);
    triangulator_.corner(paged(i));
  }
  // The same, of a polygon with all of its corners in the texture of cut_out() or paint().
  void corner(uint64_t i, const TexturePoint& texture) {
    corner(i, texture, colours_.empty() ? kWhiteCorners[0] : colours_[i]);
  }
  // The same with the colour of the corner.
  void corner(uint64_t i, const TexturePoint& texture, const VertexColour& colour) {
    if (points_ != nullptr) return triangulator_.corner(points_[i], texture, colour);
    if (!positions_->spilled()) return triangulator_.corner(stored(i), texture, colour);
    if (!is_recorded()) return triangulator_.corner(paged(i), texture, colour);
    record_texture({texture, colour});
    record(i);
  }
  // Fewer than three corners give no triangle.
  void end_polygon() {
    if (recording_) return record_end();
    triangulator_.finish(out_);
    if (positions_ && positions_->paged()) end_paged_polygon();
  }
  // A triangle without vertices, after begin_soup().
  void add(const Point& a, const Point& b, const Point& c) { out_.add(a, b, c); }
  void begin_soup() { end_mesh(); }
  // Of the polygons with texture from here on: what cuts them out, and what colours their points;
  // null: nothing, or the colours of the vertices.
  void cut_out(const CutOut* cut);
  void paint(const Paint* paint);
  // Polygons of the mesh may be cut out, which the summary counts. Call it after begin().
  void count_cut_outs() { is_counted_ = true; }
  // To a soup.
  void add_textured(const Triangle& t, const TextureCorners& texture,
                    const CornerColours& colours = kWhiteCorners) {
    out_.add_textured(t, texture, colours);
  }

  // Passes everything on.
  void finish() {
    draw_recorded();
    out_.flush();
  }
  uint64_t unplaced() const { return out_.unplaced(); }
  // After an Error of the reader: passes on the polygons that were recorded before it.
  void finish_broken();

 private:
  [[gnu::always_inline]] Point stored(uint64_t i) const {
    const Point p = (*positions_)[i];
    return is_placed_ ? to_world_(p) : p;
  }
  // The same, of vertices in pages.
  Point paged(uint64_t i) {
    const Point p = positions_->look_up(i);
    return is_placed_ ? to_world_(p) : p;
  }
  // Whether corners of spilled vertices are recorded: for the box, or because lookups are costly.
  bool is_recorded() const { return recording_ || !positions_->paged() || wants_marks(); }
  bool wants_marks() const {
    return options_.box_alone != nullptr && !is_placed_ && !is_counted_ &&
           size_ / 8 <= recording_room();
  }
  // The rest of the share is for blocks.
  uint64_t recording_room() const { return options_.spill->share - options_.spill->share / 8; }
  void end_paged_polygon();
  // Of coloured or spilled vertices. Not inline, so that the readers' loops are short.
  void rare_triangle(uint64_t a, uint64_t b, uint64_t c);
  bool fits(uint64_t bytes) const {
    return options_.spill == nullptr || bytes <= options_.spill->share;
  }
  void end_mesh();
  void grow_colours();
  void start_recording();
  void record(uint64_t i) {
    if (!recording_) start_recording();
    if (marks_) return mark(i);
    put_code(kFirstWindow + positions_->windows().record(i));
  }
  void mark(uint64_t i) {
    if (corners_ == 2) {
      for (const uint64_t earlier : first_two_) marks_->mark(earlier);
    }
    if (corners_ < 2) {
      first_two_[corners_] = i;
    } else {
      marks_->mark(i);
    }
    ++corners_;
  }
  void record_end();
  // Of a corner.
  struct Paintable {
    TexturePoint texture{0, 0};
    VertexColour colour{};
    uint16_t padding = 0;
  };
  void record_texture(const Paintable& corner);
  void record_name(uint64_t kind, std::string_view name, std::array<uint8_t, 4> more);
  void put_code(uint64_t code);
  void put_bytes(std::span<const std::byte> bytes);
  void flush_codes();
  void draw_recorded();
  void draw_box();
  void replay();

  // A recording: for each corner kFirstWindow + the number of its window, kEnd after each polygon;
  // kMesh and kMaterial with a name; kCut and kPaint with the number of one, 0: none; kTexture with
  // the place in a texture and the colour of the corner that follows.
  enum Code : uint64_t { kMesh, kMaterial, kEnd, kCut, kPaint, kTexture, kFirstWindow };

  const ReadOptions& options_;
  Triangulator triangulator_;
  BatchWriter out_;
  std::optional<Positions> positions_;  // as stored
  PointArray placed_;
  Point* points_ = nullptr;  // not null: all vertices, in the world
  uint64_t size_ = 0;        // number of vertices
  Affine to_world_ = {};
  std::vector<VertexColour> colours_;  // of the vertices, or empty
  MemoryBudget::Reservation colour_memory_;
  ReadOptions in_memory_ = {};  // options without space to spill, for vertices with colours
  const Paint by_vertices_ = {};
  std::deque<CutOut> cuts_;   // that cut_out() got, each once
  std::deque<Paint> paints_;  // that paint() got, each once
  bool is_placed_ = false;    // place() was called
  bool is_counted_ = false;   // the summary counts its triangles as undeformed or quantised

  // Of spilled positions.
  bool recording_ = false;
  bool joined_ = false;               // the recording was drawn
  bool is_partly_paged_ = false;      // and polygons before it: the recording is not complete
  uint64_t corners_ = 0;              // of the polygon that is marked
  uint64_t first_two_[2] = {};        // its first corners: alone they are no triangle
  uint64_t triangles_ = 0;            // marked
  std::optional<VertexMarks> marks_;  // only the box is wanted
  std::optional<SpillWriter> codes_out_;
  std::array<std::byte, 4096> codes_;  // not yet in codes_out_
  size_t codes_size_ = 0;
  OwnedStream codes_stream_;
};

using MeshReader = LeftOut (*)(const File& file, const ReadOptions& options, MeshWriter* out);

// Runs a reader. The same Error, behind the same triangles, whether vertices fit in memory or not.
LeftOut read_meshes(MeshReader reader, const File& file, const ReadOptions& options,
                    const TriangleSink& sink);

}  // namespace svdag
