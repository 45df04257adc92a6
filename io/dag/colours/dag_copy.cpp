#include "io/dag/colours/dag_copy.h"

#include <cstring>

namespace svdag {
namespace {

// The end of the sections and the layer table.
uint64_t geometry_end(const Header& h) {
  if (h.layer_kind != 0) return h.layers_offset + h.layers_bytes;
  const Section& last = h.sections[Layout(h.layout) == Layout::kPlain ? 0 : h.levels - 2];
  return last.offset + last.bytes;
}

}  // namespace

DagCopy::DagCopy(const DagFile& dag, const std::string& path)
    : output_(path), header_(dag.header()) {
  const uint64_t end = geometry_end(header_);
  output_.append(dag.bytes().subspan(sizeof(Header), end - sizeof(Header)));
  clear_colours(&header_);
  header_.table_hash[0] = header_.table_hash[1] = 0;
}

void DagCopy::finish() {
  header_.version =
      version_of(Layout(header_.layout), LayerKind(header_.layer_kind), has_colours(header_));
  output_.finish(&header_);
}

Header DagCopy::commit() {
  output_.commit();
  return header_;
}

DagFile DagCopy::open(const std::string& shown_as) const {
  return DagFile::map_valid(File::open_read(output_.open_name()), shown_as);
}

ColourParts::ColourParts(DagCopy* copy, uint32_t level, uint32_t error, uint64_t count)
    : copy_(copy) {
  Header& h = copy->header_;
  h.colour_level = level;
  h.colour_error = error;
  h.colour_count = count;
  hasher_.update(std::as_bytes(std::span(&h.colour_count, 1)));
  hasher_.update(std::as_bytes(std::span(&h.colour_level, 1)));
  hasher_.update(std::as_bytes(std::span(&h.colour_error, 1)));
  copy->output_.align();
  h.chunks_offset = copy->output_.position();
}

void ColourParts::add_chunks(std::span<const std::byte> bytes) {
  append(bytes);
  copy_->header_.chunks_bytes += bytes.size();
}

void ColourParts::begin_directory() {
  copy_->output_.align();
  copy_->header_.directory_offset = copy_->output_.position();
}

void ColourParts::add_entries(std::span<const std::byte> bytes) {
  append(bytes);
  copy_->header_.directory_bytes += bytes.size();
}

void ColourParts::finish() {
  const Hash128 hash = hasher_.digest();
  std::memcpy(copy_->header_.colour_hash, hash.data(), sizeof hash);
  copy_->finish();
}

void ColourParts::append(std::span<const std::byte> bytes) {
  copy_->output_.append(bytes);
  hasher_.update(bytes);
}

}  // namespace svdag
