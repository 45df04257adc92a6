#include "io/scene/mesh/mesh_reader.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace svdag {

std::string unpack_folder_of(const SpillSpace* spill) {
  if (spill != nullptr && !spill->unpack_folder.empty()) return spill->unpack_folder;
  std::error_code none;  // TMPDIR may name anything
  const std::string folder = std::filesystem::temp_directory_path(none).string();
  return none ? "/tmp" : folder;
}

File create_unpacked(const std::string& path, const SpillSpace* spill) {
  return File::create_anonymous(unpack_folder_of(spill), path);
}

void BatchWriter::mesh(std::string_view name, bool undeformed) {
  flush();
  mesh_ = name;
  material_.clear();
  colour_.reset();
  undeformed_ = undeformed;
  first_ = 0;
}

void BatchWriter::material(std::string_view name, std::optional<Colour> colour) {
  if (name == material_ && colour == colour_) return;
  flush();
  material_ = name;
  colour_ = colour;
}

void BatchWriter::mirrored(bool mirrored) {
  if (mirrored == mirrored_) return;
  flush();
  mirrored_ = mirrored;
}

void BatchWriter::cut_out(const CutOut* cut) {
  if (cut == cut_) return;
  flush();
  cut_ = cut;
}

void BatchWriter::paint(const Paint* paint) {
  if (paint == paint_) return;
  flush();
  paint_ = paint;
}

void BatchWriter::quantisation(double step) {
  if (step == quantisation_) return;
  flush();
  quantisation_ = step;
}

// All batches but the last of a mesh are full; the memory grows until the first one is.
void BatchWriter::make_room() {
  if (room_ == kBatch) return flush();
  auto larger = std::make_unique_for_overwrite<Triangle[]>(kBatch);
  std::copy_n(batch_.get(), size_, larger.get());
  batch_ = std::move(larger);
  room_ = kBatch;
}

void BatchWriter::flush() {
  if (size_ == 0) return;
  if (mirrored_) {
    for (size_t i = 0; i < size_; ++i) std::swap(batch_[i].v[1], batch_[i].v[2]);
    for (TextureCorners& corners : texture_) std::swap(corners[1], corners[2]);
    for (CornerColours& corners : corner_colours_) std::swap(corners[1], corners[2]);
  }
  sink_({.mesh = mesh_,
         .material = material_,
         .colour = colour_,
         .first = first_,
         .triangles = {batch_.get(), size_},
         .quantisation = quantisation_,
         .undeformed = undeformed_,
         .cut = cut_,
         .texture = texture_,
         .paint = paint_,
         .corner_colours = corner_colours_});
  texture_.clear();
  corner_colours_.clear();
  first_ += size_;
  size_ = 0;
}

}  // namespace svdag
