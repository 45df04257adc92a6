#include "io/formats/output.h"

#include "streaming/interrupt.h"

namespace svdag {

void Output::flush() {
  check_interrupt();
  file_.append(buffer_);
  buffer_.clear();
}

void Output::commit() {
  flush();
  file_.commit();
}

}  // namespace svdag
