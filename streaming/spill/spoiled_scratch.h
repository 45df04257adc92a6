// The content of a scratch folder cannot be resumed: it is damaged, or of another version of svdag.
// A caller that may discard it starts anew. A full or failing disk is another Error, because its
// work can be resumed later.
#pragma once

#include "streaming/error.h"

namespace svdag {

class SpoiledScratch : public Error {
 public:
  using Error::Error;
  explicit SpoiledScratch(const Error& error) : Error(error) {}
};

}  // namespace svdag
