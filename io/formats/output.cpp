#include "io/formats/output.h"

#include "streaming/process/interrupt.h"

namespace svdag {

void Output::flush() {
  check_interrupt();
  file_.append(std::span(buffer_).first(used_));
  used_ = 0;
}

void Output::commit() {
  flush();
  file_.commit();
}

}  // namespace svdag
