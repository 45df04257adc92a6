// Sub-commands that are programs of their own, as git has them.
#pragma once

namespace svdag {

// Becomes the program `name` beside this one, with the same arguments from the sub-command's on
// (argv[1] is its name). Returns only if there is no such program: an Error (kUsage) that says so.
[[noreturn]] void become_sibling(const char* name, char** argv);

}  // namespace svdag
