#include "streaming/file/input_watch.h"

namespace svdag {

void InputWatch::check() const {
  for (const WatchedFile& file : files_) {
    const FileState now = file.descriptor == kReopen ? state_of(File::open_read(file.path))
                                                     : state_of(file.descriptor, file.path);
    if (now != file.state) fail_input(file.path, kChangedInput);
  }
}

}  // namespace svdag
