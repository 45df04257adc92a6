// Names of the steps of a plan: "shard-3", "merge-1", each kind numbered from 1; "colours".
//
// A number given as a string may be a placeholder that another program replaces.
#pragma once

#include <cstddef>
#include <string>

namespace svdag {

constexpr const char* kShardPrefix = "shard-";
constexpr const char* kMergePrefix = "merge-";
constexpr const char* kColoursName = "colours";

inline std::string shard_name(const std::string& number) {
  return kShardPrefix + number;
}
inline std::string shard_name(size_t number) {
  return shard_name(std::to_string(number));
}
inline std::string merge_name(const std::string& number) {
  return kMergePrefix + number;
}
inline std::string merge_name(size_t number) {
  return merge_name(std::to_string(number));
}

inline bool is_shard_name(const std::string& name) {
  return name.starts_with(kShardPrefix);
}
// "merge-12" -> "12".
inline std::string number_in(const std::string& name) {
  return name.substr(name.find('-') + 1);
}

}  // namespace svdag
