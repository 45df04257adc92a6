// Messages about wrong command lines: unknown words, values that are missing, and the errors of
// CLI11 in plain words.
//
// CLI11 takes the next word as the value of an option, whatever it is. "-o $OUT --quiet" with an
// empty OUT would write a file named "--quiet", "-o=$OUT" a file named "=city.svdag", and an empty
// number would be ignored. A file that is named like an option can be given as ./--quiet.
#pragma once

#include <span>
#include <string>

#include "io/help/manual.h"

namespace svdag {

// The command that the words name, else the program.
const Manual& command_of(const Manual& program, std::span<const std::string> words);

// A message about the first word that is neither a command nor an option of its command, with a
// suggestion, or about the first option whose value is missing; "" if there is none. The words
// behind --help or --version are not checked.
std::string explain_words(const Manual& program, std::span<const std::string> words);

// Rewrites an error message of CLI11 in the style of this program's messages. Returns other
// messages unchanged.
std::string plain_usage_error(const std::string& message);

}  // namespace svdag
