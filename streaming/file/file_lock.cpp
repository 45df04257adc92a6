#include "streaming/file/file_lock.h"

#include <sys/file.h>

#include "streaming/file/file.h"
#include "streaming/file/system_call.h"

namespace svdag {

bool is_locked(const std::string& path) {
  try {
    const File file = File::open_read(path);
    const auto lock = [&] { return ::flock(file.descriptor(), LOCK_SH | LOCK_NB); };
    return retry_interrupted(lock) != 0 && errno == EWOULDBLOCK;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace svdag
