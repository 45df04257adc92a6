// A file mapped into memory for reading.
//
// A page that can no longer be read, because the file was cut short meanwhile or its disk or server
// failed, is no error that a call returns: the access ends in SIGBUS, wherever in the code it is.
// So main() has that end the program, with the sentence and the exit code of any other input that
// cannot be read. What a cut leaves of its last page reads as zeros, without a signal: so nothing
// is committed, and no program ends well, before the size of what is mapped, and when it was last
// written, were asked once more. A file that is written while it is read may lead a program
// anywhere, for what was checked is no longer there: if that ends in SIGSEGV or in any error, it is
// the write that is told.
// Rejected: pread for every node of a DAG; a jump out of the access (locks would stay taken,
// destructors would not run).
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "streaming/file/file.h"
#include "streaming/file/file_state.h"

namespace svdag {

class MappedFile {
 public:
  // The first `size` bytes of `file`, which are there; `before` is what it was when the first of
  // them was read. Throws Error (kBadInput).
  MappedFile(File file, size_t size, const FileState& before);
  MappedFile(MappedFile&&) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  const void* data() const;
  const std::string& path() const;

  struct Mapping;

 private:
  std::unique_ptr<const Mapping> mapping_;
};

// From now on a lost page of any MappedFile ends the process: "`program`: PATH: why" on standard
// error, exit code kBadInput; so does SIGSEGV, if one of them was written. Signals of any other
// cause do what they did before. For main().
void tell_of_lost_pages(const char* program);

// Throws Error (kBadInput) if a file that is mapped now was cut short or written.
void require_mapped_files();
// That sentence if one that was ever mapped was, or null; it stays while no file is unmapped. For
// main().
const std::string* changed_mapped_file() noexcept;

}  // namespace svdag
