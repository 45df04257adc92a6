// Selects parts of a scene by shell patterns (*, ?, [..]) against their names.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace svdag {

// What has names in a scene.
enum class PartKind {
  kObject,    // glTF nodes (a node is selected with its ancestors), OBJ groups and objects, solids
              // of text STL; "" where the format has no names
  kMaterial,  // of glTF primitives and OBJ faces
  kFile,      // the file's name without its folder
  kFrame,     // the time of a pose; no pattern applies to it
};
constexpr PartKind kPartKinds[] = {PartKind::kObject, PartKind::kMaterial, PartKind::kFile};
const char* name_of(PartKind kind);

// A pattern "KIND:PATTERN" (object:, material: or file:) applies to one kind, any other pattern to
// all. A triangle is selected if nothing excludes its object, material or file, and something
// includes one of them.
struct NameFilter {
  // What a pass over a scene finds out about the patterns.
  struct Use {
    std::vector<bool> include, exclude;                // whether each pattern matched a name
    std::set<std::pair<std::string, PartKind>> names;  // met so far; at most kMaxNames
    std::vector<bool> cut_out = {};
    static constexpr size_t kMaxNames = 10000;
  };

  std::vector<std::string> include;       // if not empty, only what matches one of these
  std::vector<std::string> exclude;       // nothing that matches one of these
  Use* use = nullptr;                     // if not null, is filled
  std::vector<std::string> cut_out = {};  // materials to cut out, whatever the file says

  bool excludes(PartKind kind, const std::string& name) const;
  // True if `include` is empty.
  bool includes(PartKind kind, const std::string& name) const;
  bool cuts_out(const std::string& material) const;
  bool empty() const { return include.empty() && exclude.empty(); }
};

// The names most like `pattern`, as text for users: "object:Sky", "material:sky_blue"; at most 3.
std::string nearest_names(const std::string& pattern, const NameFilter::Use& use);

}  // namespace svdag
