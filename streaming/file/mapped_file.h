// A file mapped into memory for reading.
//
// If a page can no longer be read, because the file was truncated or its disk or server failed, the
// access raises SIGBUS anywhere in the code. main() installs a handler that ends the program with
// the message and exit code of any other unreadable input. The rest of a truncated file's last page
// reads as zeros, without a signal. Therefore size and modification time of all mapped files are
// checked again before an output is committed and before a program exits with success. Content that
// changes after it was checked may cause any error, SIGSEGV included: then the change is reported
// as the cause.
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
  // Maps the first `size` bytes of `file`, which must exist; `before`: state of the file before it
  // was read first. Error: kBadInput.
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

// Installs the handlers: a lost page of a MappedFile ends the process with "`program`: PATH: why"
// on stderr and exit code kBadInput, and so does SIGSEGV if a mapped file was changed. Signals of
// other causes keep their effect. For main().
void tell_of_lost_pages(const char* program);

// Throws Error (kBadInput) if a currently mapped file was truncated or written.
void require_mapped_files();
// The same message if a file that is or was mapped has changed, else null. Valid while no file is
// unmapped. For main().
const std::string* changed_mapped_file() noexcept;

}  // namespace svdag
