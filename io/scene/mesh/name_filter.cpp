#include "io/scene/mesh/name_filter.h"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "io/suggest.h"

namespace svdag {
namespace {

struct Pattern {
  std::optional<PartKind> kind;  // nothing: every kind
  std::string text;
};

Pattern parse(const std::string& pattern) {
  for (const PartKind kind : kPartKinds) {
    const std::string prefix = std::string(name_of(kind)) + ":";
    if (pattern.starts_with(prefix)) return {kind, pattern.substr(prefix.size())};
  }
  return {{}, pattern};
}

bool matches(const std::string& pattern, PartKind kind, const std::string& name) {
  const Pattern p = parse(pattern);
  return (!p.kind || *p.kind == kind) && fnmatch(p.text.c_str(), name.c_str(), 0) == 0;
}

// *use: the patterns that match this or an earlier name; null: not recorded.
bool matches_any(const std::vector<std::string>& patterns, PartKind kind, const std::string& name,
                 std::vector<bool>* use) {
  bool any = false;
  for (size_t i = 0; i < patterns.size() && !(any && use == nullptr); ++i) {
    if (!matches(patterns[i], kind, name)) continue;
    any = true;
    if (use != nullptr) (*use)[i] = true;
  }
  return any;
}

void record(NameFilter::Use* use, PartKind kind, const std::string& name) {
  if (use->names.size() < NameFilter::Use::kMaxNames) use->names.emplace(name, kind);
}

// Letters and digits of a pattern or name, in lower case.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += char(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

}  // namespace

const char* name_of(PartKind kind) {
  switch (kind) {
    case PartKind::kObject:
      return "object";
    case PartKind::kMaterial:
      return "material";
    case PartKind::kFile:
      return "file";
    case PartKind::kFrame:
      return "frame";
  }
  return "";
}

bool NameFilter::excludes(PartKind kind, const std::string& name) const {
  if (exclude.empty()) return false;
  if (use != nullptr) record(use, kind, name);
  return matches_any(exclude, kind, name, use == nullptr ? nullptr : &use->exclude);
}

bool NameFilter::includes(PartKind kind, const std::string& name) const {
  if (include.empty()) return true;
  if (use != nullptr) record(use, kind, name);
  return matches_any(include, kind, name, use == nullptr ? nullptr : &use->include);
}

bool NameFilter::cuts_out(const std::string& material) const {
  if (cut_out.empty()) return false;
  if (use != nullptr) record(use, PartKind::kMaterial, material);
  return matches_any(cut_out, PartKind::kMaterial, material,
                     use == nullptr ? nullptr : &use->cut_out);
}

std::string nearest_names(const std::string& pattern, const NameFilter::Use& use) {
  constexpr size_t kShown = 3, kMaxLength = 200;
  const Pattern p = parse(pattern);
  const std::string wanted = plain(p.text);
  // A name of the right kind, or that contains the pattern, is near.
  std::vector<std::pair<size_t, std::string>> found;
  for (const auto& [name, kind] : use.names) {
    if (name.empty() || name.size() > kMaxLength) continue;
    const std::string text = plain(name);
    const bool contains = !wanted.empty() && text.find(wanted) != std::string::npos;
    const size_t wrong_kind = p.kind && *p.kind != kind ? 1 : 0;
    found.emplace_back((contains ? 0 : 1 + edit_distance(wanted, text)) + wrong_kind,
                       std::string(name_of(kind)) + ":" + name);
  }
  std::sort(found.begin(), found.end());
  std::string list;
  for (size_t i = 0; i < std::min(found.size(), kShown); ++i)
    list += (i == 0 ? "" : ", ") + found[i].second;
  return list;
}

}  // namespace svdag
