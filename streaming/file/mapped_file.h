// A file mapped into memory for reading.
//
// If a page cannot be read, because the file was truncated or its disk or server failed, the access
// raises SIGBUS anywhere in the code. run_program() installs a handler that ends the process with
// the message and exit code of any other unreadable input. The rest of a truncated file's last page
// reads as zeros, without a signal. Therefore size and modification time of all mapped files are
// checked again before an output is committed and before a program exits with success. Content that
// changes after it was checked may cause any error, even SIGSEGV: the change is then reported as
// the cause.
// Rejected: pread for every node of a DAG; a jump out of the failed access (locks would stay taken,
// destructors would not run).
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "streaming/file/file.h"
#include "streaming/file/input_watch.h"

namespace svdag {

class MappedFile {
 public:
  // Maps the first `size` bytes of `file`, from 1 to its size. `before`: the file's state before
  // its first read. Error: kBadInput.
  MappedFile(File file, size_t size, const FileState& before);
  MappedFile(MappedFile&&) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  // The first byte, aligned to a page.
  const void* data() const;
  const std::string& path() const;

  struct Mapping;

 private:
  std::unique_ptr<const Mapping> mapping_;
};

// Installs handlers of SIGBUS and SIGSEGV for the whole process: a lost page of a MappedFile ends
// it with "`program`: PATH: reason" on stderr and exit code kBadInput, and so does SIGSEGV if a
// mapped file has changed. Signals of other causes keep their effect. `program` must stay valid.
// Called once, by run_program().
void install_lost_page_handlers(const char* program);

// Throws Error (kBadInput) if a currently mapped file has been truncated or written.
void require_mapped_files();
// Returns the message of that Error if a file that is or was mapped has changed, else null. Valid
// until a file is unmapped. Called by run_program().
const std::string* changed_mapped_file() noexcept;

}  // namespace svdag
