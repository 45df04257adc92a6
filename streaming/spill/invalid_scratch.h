// The Error for a scratch folder whose content cannot be resumed: it is damaged, or of another
// version of svdag. A caller that may discard it starts over. A full or failing disk is a plain
// Error, because the work can be resumed later.
#pragma once

#include "streaming/error.h"

namespace svdag {

class InvalidScratch : public Error {
 public:
  using Error::Error;
  explicit InvalidScratch(const Error& error) : Error(error) {}
};

}  // namespace svdag
