// Man pages in the macros of man(7): section 1 for commands, section 7 for topics.
#pragma once

#include "io/help/manual.h"

namespace svdag {

// What all pages have in common.
struct PageConfig {
  std::string version;                // "svdag 0.1.0"
  std::vector<std::string> see_also;  // "svdag(1)"
};

std::string command_page(const Manual& manual, const PageConfig& config);

// `text` begins with "NAME: description".
std::string topic_page(std::string_view text, const PageConfig& config);

// The NAME of a topic's text.
std::string topic_name(std::string_view text);

}  // namespace svdag
