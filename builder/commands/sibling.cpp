#include "builder/commands/sibling.h"

#include <unistd.h>

#include <filesystem>

#include "streaming/error.h"

namespace svdag {

void become_sibling(const char* name, char** argv) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string program = self.parent_path() / name;
  ::execv(program.c_str(), argv + 1);
  fail_usage("svdag " + std::string(argv[1]) + " needs the program " + program +
             ", which is not there or does not start: install it beside svdag");
}

}  // namespace svdag
