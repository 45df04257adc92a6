// Values that were lost on their way to the command line: a script's $OUT that was never set.
//
// CLI11 gives an option whatever word comes next. After "-o $OUT --quiet" that would be a file
// named
// "--quiet", after "-o=$OUT" one named "=city.svdag", and an empty number is one that was not
// given. So words are looked at before they are parsed. A file that is named like an option is
// ./--quiet.
#pragma once

#include <span>
#include <string>

namespace CLI {
class App;
}

namespace svdag {

// A message about the first value that cannot be intended; "" if all may be. `words` without the
// program's name; words that are not options of the command are not checked.
std::string explain_lost_value(const CLI::App& program, std::span<const std::string> words);

}  // namespace svdag
