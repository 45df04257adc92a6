// What lies in a scratch folder can never be gone on with: it is damaged, or another version of
// svdag left it. Whoever may discard it begins anew; a disk that is full or fails is another Error,
// for there the work is worth waiting for.
#pragma once

#include "streaming/error.h"

namespace svdag {

class SpoiledScratch : public Error {
 public:
  using Error::Error;
  explicit SpoiledScratch(const Error& error) : Error(error) {}
};

}  // namespace svdag
