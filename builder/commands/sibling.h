// Sub-commands that are separate programs, like those of git.
#pragma once

namespace svdag {

// Replaces this process by the program `name` in the same folder, with the arguments from argv[1],
// the sub-command's name. Error (kUsage) if the program is not found.
[[noreturn]] void become_sibling(const char* name, char** argv);

}  // namespace svdag
