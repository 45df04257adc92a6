// Pages for man(1) in the macros of man(7): section 1 of the manual of a command, section 7 of a
// topic.
#pragma once

#include "io/help/manual.h"

namespace svdag {

// The content of every page.
struct PageConfig {
  std::string version;                // "svdag 0.1.0"
  std::vector<std::string> see_also;  // "svdag(1)"
};

std::string command_page(const Manual& manual, const PageConfig& config);

// `text` begins with "NAME: what it is about".
std::string topic_page(std::string_view text, const PageConfig& config);

// The NAME of a topic's text.
std::string topic_name(std::string_view text);

}  // namespace svdag
