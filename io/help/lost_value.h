// Detects missing option values, such as an unset $OUT in a script, before the command line is
// parsed.
//
// CLI11 takes the next word as the value of an option, whatever it is. "-o $OUT --quiet" with an
// empty OUT would write a file named "--quiet", "-o=$OUT" a file named "=city.svdag", and an empty
// number would be ignored. A file that is named like an option can be given as ./--quiet.
#pragma once

#include <span>
#include <string>

namespace CLI {
class App;
}

namespace svdag {

// A message about the first option whose value is missing; "" if there is none. `words` does not
// include the program's name; words that are not options of the command are not checked.
std::string explain_missing_value(const CLI::App& program, std::span<const std::string> words);

}  // namespace svdag
