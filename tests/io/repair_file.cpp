// repair_file KIND FILE: recomputes the checksums of a changed file, for tests in Python. The exit
// code is not 0 if the file is empty or the kind is unknown.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "builder/farm/plan/plan.h"
#include "tests/repair_checksums.h"
#include "tests/repair_files.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string kind = argv[1];
  std::ifstream in(argv[2], std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (kind == "svdag") {
    svdag::repair_checksums(&bytes);
  } else if (kind == "run") {
    svdag::repair_run(&bytes);
  } else if (kind == "pack") {
    svdag::repair_pack(&bytes);
  } else if (kind == "journal") {
    svdag::repair_journal(&bytes);
  } else if (kind == "plan") {
    svdag::seal_plan(&bytes);
  } else {
    return 2;
  }
  std::ofstream(argv[2], std::ios::binary) << bytes;
  return bytes.empty() ? 1 : 0;
}
