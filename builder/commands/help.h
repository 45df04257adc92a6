// Topics of `svdag help TOPIC`: concepts that concern several commands.
//
// A topic is a text file (builder/commands/topics) that the build embeds in the program, so help
// works without installed files or a man page viewer.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "builder/commands/commands.h"

namespace svdag {

struct Topic {
  std::string_view name;
  std::string_view text;  // the first line is "NAME: its subject"
};

std::span<const Topic> topics();

// The possible arguments of `svdag help`: all commands except help, and all topics.
std::vector<std::string> help_subjects(const Manual& program);

// "Topics:", then a line per topic.
std::string list_of_topics();

}  // namespace svdag
