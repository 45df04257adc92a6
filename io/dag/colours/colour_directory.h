// The directory of a file's colours while it is written: kept in an anonymous file except for the
// newest entries, because the mean of a cube above chunks is known only after its descendants.
#pragma once

#include <string>
#include <vector>

#include "io/dag/format.h"
#include "streaming/file/file.h"

namespace svdag {

class ColourDirectory {
 public:
  explicit ColourDirectory(const std::string& folder) : folder_(folder) {}

  uint64_t size() const { return stored_ + recent_.size(); }
  // Returns the number of the entry.
  uint64_t add(const ColourEntry& entry) {
    if (recent_.size() == kKept) store();
    recent_.push_back(entry);
    return size() - 1;
  }
  void set_value(uint64_t number, uint64_t value) {
    if (number >= stored_) {
      recent_[size_t(number - stored_)].value = value;
    } else {
      file_.write_at(number * sizeof(ColourEntry) + offsetof(ColourEntry, value),
                     std::as_bytes(std::span(&value, 1)));
    }
  }
  // Calls visit(bytes) for all entries in order, in parts.
  template <class Visit>
  void visit_all(const Visit& visit) {
    if (stored_ > 0) {
      store();
      recent_.resize(kKept);
      for (uint64_t at = 0; at < stored_; at += kKept) {
        const auto part =
            std::as_writable_bytes(std::span(recent_).first(std::min(kKept, stored_ - at)));
        file_.read_at(at * sizeof(ColourEntry), part);
        visit(std::span<const std::byte>(part));
      }
      recent_.clear();
    } else {
      visit(std::as_bytes(std::span(recent_)));
    }
  }

 private:
  static constexpr uint64_t kKept = 65536;

  void store() {
    if (stored_ == 0) file_ = File::create_anonymous(folder_);
    file_.write_at(stored_ * sizeof(ColourEntry), std::as_bytes(std::span(recent_)));
    stored_ += recent_.size();
    recent_.clear();
  }

  std::string folder_;
  File file_;
  uint64_t stored_ = 0;
  std::vector<ColourEntry> recent_;
};

}  // namespace svdag
