// Writes a copy of a `.svdag` file without its colours, to which others may be added.
#pragma once

#include <span>
#include <string>

#include "io/dag/dag_file.h"
#include "io/dag/write/dag_file_output.h"
#include "streaming/file/checksum.h"

namespace svdag {

// The sections and layers of another file. After finish(), the file gets its name or is opened
// without one.
class DagCopy {
 public:
  DagCopy(const DagFile& dag, const std::string& path);

  const Header& header() const { return header_; }
  // Writes the rest: metadata, checksums, header.
  void finish();
  // Gives the file its name and returns the header.
  Header commit();
  // The file without a name; errors show `shown_as`.
  DagFile open(const std::string& shown_as) const;

 private:
  friend class ColourParts;

  DagFileOutput output_;
  Header header_;
};

// Appends the parts of the colours to a copy, and hashes them: all chunks, then all entries.
class ColourParts {
 public:
  ColourParts(DagCopy* copy, uint32_t level, uint32_t error, uint64_t count);

  void add_chunks(std::span<const std::byte> bytes);
  void begin_directory();
  void add_entries(std::span<const std::byte> bytes);
  // Finishes the copy, too.
  void finish();

 private:
  void append(std::span<const std::byte> bytes);

  DagCopy* copy_;
  Hasher128 hasher_;
};

}  // namespace svdag
