// svdag help [COMMAND|TOPIC]: what the options of one command cannot explain.
//
// Topics are plain texts (builder/commands/topics), put into the program when it is built: help
// must be there when a package is not whole, and no page is needed to read it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "builder/commands/commands.h"

namespace svdag {

struct Topic {
  std::string_view name;
  std::string_view text;  // its first line: "NAME: what it is about"
};

std::span<const Topic> topics();

// What follows `svdag help`: commands, but for help itself, and topics.
std::vector<std::string> help_subjects(const Manual& program);

// "Topics:" and a line for each.
std::string list_of_topics();

}  // namespace svdag
