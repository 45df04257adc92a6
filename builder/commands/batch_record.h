// The bakes of a batch that are up to date: its previous --report records each finished bake by the
// hash of its description and the hash of its output's content.
//
// A bake is up to date if the description (input hashes, grid, rule, parts of the scene, algorithm)
// has the recorded hash, and the output exists with the recorded content hash. Inputs are read,
// outputs by their header alone. Rejected: modification times, which copies and checkouts change.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "builder/commands/commands.h"

namespace svdag {

class BatchRecord {
 public:
  // Reads the report of an earlier run. A missing file, or a file that is not such a report, is an
  // empty record.
  static BatchRecord read(const std::string& path);

  // The recorded report of `job`, as JSON text; nothing unless the bake is up to date.
  std::optional<std::string> report_if_up_to_date(const BakeCommand& job) const;

 private:
  struct Entry {
    std::string description_hash, content_hash;
    std::string report;
  };

  std::map<std::string, Entry> entries_;  // by output
};

}  // namespace svdag
