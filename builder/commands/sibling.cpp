#include "builder/commands/sibling.h"

#include <unistd.h>

#include <filesystem>

#include "streaming/error.h"
#include "streaming/process/child_process.h"

namespace svdag {

void become_sibling(const char* name, char** argv) {
  const std::string program = std::filesystem::path(own_program()).parent_path() / name;
  ::execv(program.c_str(), argv + 1);
  fail_usage("svdag " + std::string(argv[1]) + ": cannot start the program " + program +
             ": install it beside svdag");
}

}  // namespace svdag
