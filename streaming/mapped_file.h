// A file mapped into memory for reading.
//
// A page that can no longer be read, because the file was cut short meanwhile or its disk or server
// failed, is no error that a call returns: the access ends in SIGBUS, wherever in the code it is.
// So main() has that end the program, with the sentence and the exit code of any other input that
// cannot be read. Rejected: pread for every node of a DAG; a jump out of the access (locks would
// stay taken, destructors would not run).
#pragma once

#include <cstddef>
#include <memory>

#include "streaming/file.h"

namespace svdag {

class MappedFile {
 public:
  // The first `size` bytes of `file`, which are there. Throws Error (kBadInput).
  MappedFile(const File& file, size_t size);
  MappedFile(MappedFile&&) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  const void* data() const;

  struct Mapping;

 private:
  std::unique_ptr<const Mapping> mapping_;
};

// From now on a lost page of any MappedFile ends the process: "`program`: PATH: why" on standard
// error, exit code kBadInput. SIGBUS of any other cause does what it did before. For main().
void tell_of_lost_pages(const char* program);

}  // namespace svdag
