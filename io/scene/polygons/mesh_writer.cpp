#include "io/scene/polygons/mesh_writer.h"

#include <algorithm>
#include <cstring>

#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// The marks of vertices do not determine the box: the file must be read again without them.
struct BoxIsUncertain {};

// The codes of a recording, one after the other.
class CodeReader {
 public:
  CodeReader(const OwnedStream& stream, MemoryBudget* budget) : reader_(stream.read(budget)) {}

  bool at_end() {
    if (here_ == end_) refill();
    return here_ == end_;
  }
  uint8_t byte() {
    if (at_end()) fail_changed();
    return uint8_t(*here_++);
  }
  uint64_t code() {
    uint64_t code = 0;
    for (int shift = 0;; shift += 7) {
      const uint8_t next = byte();
      code |= uint64_t(next & 0x7f) << shift;
      if (next < 0x80) return code;
    }
  }
  std::string text() {
    std::string text(code(), '\0');
    for (char& c : text) c = char(byte());
    return text;
  }

 private:
  void refill() {
    check_interrupt();
    const auto block = reader_.next();
    here_ = block.data();
    end_ = here_ + block.size();
  }

  SpillReader reader_;
  const std::byte *here_ = nullptr, *end_ = nullptr;
};

// Null, or the address of `given` in `all`, each once: a recording may outlive the reader.
template <class Use>
const Use* own_copy(const Use* given, std::deque<Use>* all) {
  if (given == nullptr) return nullptr;
  const auto found = std::ranges::find(*all, *given);
  return found != all->end() ? &*found : &all->emplace_back(*given);
}

// Its number from 1 on; 0: null.
template <class Use>
uint64_t number_in(const std::deque<Use>& all, const Use* own) {
  return own == nullptr ? 0 : 1 + uint64_t(std::ranges::find(all, *own) - all.begin());
}

template <class Use>
const Use* with_number(const std::deque<Use>& all, uint64_t number) {
  if (number > all.size()) fail_changed();
  return number == 0 ? nullptr : &all[size_t(number - 1)];
}

LeftOut read_once(MeshReader reader, const File& file, const ReadOptions& options,
                  const TriangleSink& sink) {
  MeshWriter out(options, file.path(), sink);
  LeftOut left_out;
  try {
    left_out = reader(file, options, &out);
  } catch (const Error& error) {
    if (error.code() == ExitCode::kBadInput) out.finish_broken();
    throw;
  }
  out.finish();
  left_out.add(Omission::kTexturePoints, out.unplaced());
  return left_out;
}

}  // namespace

Point* PointArray::resize(uint64_t count, MemoryBudget* budget) {
  if (count > capacity_) {
    release();
    memory_ = budget->reserve(count * sizeof(Point), "vertices in the world");
    points_ = std::make_unique_for_overwrite<Point[]>(size_t(count));
    capacity_ = count;
  }
  return points_.get();
}

void PointArray::release() {
  points_.reset();
  memory_.release();
  capacity_ = 0;
}

void MeshWriter::mesh(std::string_view name, bool undeformed) {
  is_counted_ |= undeformed;
  if (recording_ && !marks_) return record_name(kMesh, name, {undeformed});
  out_.mesh(name, undeformed);
}

void MeshWriter::material(std::string_view name, std::optional<Colour> colour) {
  if (recording_ && !marks_) {
    const Colour c = colour.value_or(Colour());
    return record_name(kMaterial, name, {colour.has_value(), c.r, c.g, c.b});
  }
  out_.material(name, colour);
}

void MeshWriter::cut_out(const CutOut* cut) {
  const CutOut* const own = own_copy(cut, &cuts_);
  if (!recording_) return out_.cut_out(own);
  if (marks_) return;
  put_code(kCut);
  put_code(number_in(cuts_, own));
}

void MeshWriter::paint(const Paint* paint) {
  const Paint* const own = own_copy(paint, &paints_);
  if (!recording_) return out_.paint(own == nullptr && !colours_.empty() ? &by_vertices_ : own);
  if (marks_) return;
  put_code(kPaint);
  put_code(number_in(paints_, own));
}

void MeshWriter::record_texture(const Paintable& corner) {
  if (!recording_) start_recording();
  if (marks_) return;
  put_code(kTexture);
  put_bytes(std::as_bytes(std::span(&corner, 1)));
}

void MeshWriter::end_mesh() {
  draw_recorded();
  positions_.reset();
  codes_stream_ = OwnedStream();
  out_.paint(nullptr);
  colours_ = {};
  colour_memory_.release();
  points_ = nullptr;
  size_ = 0;
  is_placed_ = joined_ = is_partly_paged_ = is_counted_ = false;
}

void MeshWriter::begin(Precision precision, uint64_t max_count, const Affine* only_place) {
  end_mesh();
  if (only_place != nullptr && max_count > 0 && fits(max_count * sizeof(Point))) {
    points_ = placed_.resize(max_count, options_.budget);
    to_world_ = *only_place;
    return;
  }
  if (options_.spill != nullptr && !fits(placed_.bytes() + 2 * max_count * sizeof(Point)))
    placed_.release();
  positions_.emplace(options_, precision, max_count);
}

void MeshWriter::begin_coloured(Precision precision, uint64_t max_count) {
  end_mesh();
  in_memory_ = options_;
  in_memory_.spill = nullptr;
  positions_.emplace(in_memory_, precision, max_count);
  colour_memory_ = options_.budget->reserve(0, "colours of vertices");
  out_.paint(&by_vertices_);
}

void MeshWriter::grow_colours() {
  const size_t room = std::max<size_t>(1024, 2 * colours_.size());
  colour_memory_.resize(room * sizeof(VertexColour), "colours of vertices");
  colours_.reserve(room);
}

bool MeshWriter::place(const Affine& to_world, double step) {
  draw_recorded();
  out_.mirrored(is_mirror(to_world));
  out_.quantisation(step == 0 ? 0 : step * axis_stretch(to_world));
  if (!positions_) return true;  // placed as they came, or a soup
  to_world_ = to_world;
  is_placed_ = true;
  if (is_partly_paged_) {  // this time all polygons are recorded
    codes_stream_ = OwnedStream();
    joined_ = is_partly_paged_ = false;
    positions_->start_join(false);
    return true;
  }
  if (joined_) {
    replay();
    return false;
  }
  if (positions_->spilled() || size_ == 0 || !colours_.empty()) return true;
  if (fits(positions_->bytes() + size_ * sizeof(Point))) {
    points_ = placed_.resize(size_, options_.budget);
    for (uint64_t i = 0; i < size_; ++i) points_[i] = to_world((*positions_)[i]);
  }
  return true;
}

void MeshWriter::start_recording() {
  recording_ = true;
  corners_ = triangles_ = 0;
  const SpillSpace& space = *options_.spill;
  if (positions_->paged()) {
    marks_.emplace(options_.budget, recording_room());
  } else {
    codes_out_.emplace(space.file(), space.stream_number(), options_.budget);
    codes_size_ = 0;
  }
}

// The vertices of a placed mesh may be needed for a further place.
void MeshWriter::end_paged_polygon() {
  if (!positions_->pages().is_costly()) return;
  is_partly_paged_ = is_placed_;
  positions_->start_join(is_placed_);
}

void MeshWriter::record_end() {
  if (!recording_) return;  // a polygon without corners
  if (marks_) {
    check_interrupt();
    if (corners_ >= 3) triangles_ += corners_ - 2;
  } else {
    put_code(kEnd);
  }
  corners_ = 0;
}

void MeshWriter::record_name(uint64_t kind, std::string_view name, std::array<uint8_t, 4> more) {
  put_code(kind);
  put_bytes(std::as_bytes(std::span(more)));
  put_code(name.size());
  put_bytes(std::as_bytes(std::span(name)));
}

void MeshWriter::put_code(uint64_t code) {
  if (codes_size_ + 10 > codes_.size()) flush_codes();
  for (; code >= 0x80; code >>= 7) codes_[codes_size_++] = std::byte(code | 0x80);
  codes_[codes_size_++] = std::byte(code);
}

void MeshWriter::put_bytes(std::span<const std::byte> bytes) {
  flush_codes();
  codes_out_->append(bytes);
}

void MeshWriter::flush_codes() {
  check_interrupt();
  codes_out_->append(std::span(codes_).first(codes_size_));
  codes_size_ = 0;
}

// Ends the recording, if there is one, and passes its polygons on.
void MeshWriter::draw_recorded() {
  if (!recording_) return;
  recording_ = false;
  positions_->hand_over();
  if (marks_) return draw_box();
  flush_codes();
  codes_stream_ = OwnedStream(options_.spill->file(), codes_out_->finish());
  codes_out_.reset();
  positions_->windows().join();
  joined_ = true;
  replay();
}

void MeshWriter::rare_triangle(uint64_t a, uint64_t b, uint64_t c) {
  if (!colours_.empty())
    return out_.add_textured({{stored(a), stored(b), stored(c)}}, TextureCorners(),
                             {colours_[a], colours_[b], colours_[c]});
  if (!is_recorded()) {
    const Point p = paged(a), q = paged(b), r = paged(c);
    out_.add(p, q, r);
    return end_paged_polygon();
  }
  record(a);
  record(b);
  record(c);
  record_end();
}

void MeshWriter::finish_broken() {
  if (marks_) throw BoxIsUncertain();  // a triangle before the Error may be invalid
  draw_recorded();
}

void MeshWriter::draw_box() {
  const auto box = marks_->box(&positions_->pages());
  if (!box) throw BoxIsUncertain();
  options_.box_alone->box.add(*box);
  options_.box_alone->triangles += triangles_;
  marks_.reset();
}

void MeshWriter::replay() {
  VertexWindows& windows = positions_->windows();
  windows.rewind();
  CodeReader codes(codes_stream_, options_.budget);
  std::array<Point, 3> first;
  std::array<Paintable, 3> first_paintable;
  Paintable paintable;
  bool is_textured = false;  // the polygon
  uint64_t corners = 0;
  const auto add_corner = [&](const Point& p, const Paintable& at) {
    is_textured ? triangulator_.corner(p, at.texture, at.colour) : triangulator_.corner(p);
  };
  while (!codes.at_end()) {
    const uint64_t code = codes.code();
    if (code >= kFirstWindow) {
      const Point as_stored = windows.next(code - kFirstWindow);
      const Point p = is_placed_ ? to_world_(as_stored) : as_stored;
      if (corners < 3) {
        first[corners] = p;
        first_paintable[corners] = paintable;
      } else {
        for (size_t i = 0; corners == 3 && i < 3; ++i) add_corner(first[i], first_paintable[i]);
        add_corner(p, paintable);
      }
      ++corners;
    } else if (code == kEnd) {
      if (corners == 3 && is_textured) {
        const auto& [a, b, c] = first_paintable;
        out_.add_textured({first}, {a.texture, b.texture, c.texture},
                          {a.colour, b.colour, c.colour});
      }
      if (corners == 3 && !is_textured) out_.add(first[0], first[1], first[2]);
      if (corners > 3) triangulator_.finish(out_);
      corners = 0;
      is_textured = false;
    } else if (code == kTexture) {
      std::array<uint8_t, sizeof paintable> bytes;
      for (uint8_t& each : bytes) each = codes.byte();
      std::memcpy(&paintable, bytes.data(), sizeof paintable);
      is_textured = true;
    } else if (code == kCut) {
      out_.cut_out(with_number(cuts_, codes.code()));
    } else if (code == kPaint) {
      out_.paint(with_number(paints_, codes.code()));
    } else {
      std::array<uint8_t, 4> more;
      for (uint8_t& each : more) each = codes.byte();
      const std::string name = codes.text();
      if (code == kMesh) {
        out_.mesh(name, more[0] != 0);
      } else {
        out_.material(
            name, more[0] != 0 ? std::optional(Colour{more[1], more[2], more[3]}) : std::nullopt);
      }
    }
  }
}

LeftOut read_meshes(MeshReader reader, const File& file, const ReadOptions& options,
                    const TriangleSink& sink) {
  if (options.box_alone == nullptr || options.spill == nullptr)
    return read_once(reader, file, options, sink);
  const MeshBox before = *options.box_alone;
  uint64_t passed = 0;
  const TriangleSink counting = [&](const TriangleBatch& batch) {
    sink(batch);
    passed += batch.triangles.size();
  };
  try {
    return read_once(reader, file, options, counting);
  } catch (const BoxIsUncertain&) {
  }
  *options.box_alone = before;
  ReadOptions again = options;
  again.box_alone = nullptr;
  return read_once(reader, file, again, [&](const TriangleBatch& batch) {
    const uint64_t known = std::min<uint64_t>(passed, batch.triangles.size());
    passed -= known;
    if (known == batch.triangles.size()) return;
    TriangleBatch rest = batch;
    rest.triangles = batch.triangles.subspan(size_t(known));
    rest.first += known;
    sink(rest);
  });
}

}  // namespace svdag
