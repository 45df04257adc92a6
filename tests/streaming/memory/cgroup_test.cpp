#include "streaming/memory/cgroup.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/temp_folder.h"

namespace svdag {
namespace {

class Cgroup : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = folder_.path() + "/" + name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << "\n";
  }
  uint64_t limit() const {
    return cgroup_memory_limit(folder_.path() + "/groups", folder_.path() + "/mounted");
  }

 private:
  TempFolder folder_;
};

TEST_F(Cgroup, TheLimitOfTheProcessGroupCounts) {
  write("groups", "0::/system.slice/job-7");
  write("mounted/memory.max", "max");
  write("mounted/system.slice/memory.max", "max");
  write("mounted/system.slice/job-7/memory.max", "314572800");
  EXPECT_EQ(limit(), 314572800U);
}

TEST_F(Cgroup, TheLowestLimitOnThePathToTheRootCounts) {
  write("groups", "0::/a/b/c");
  write("mounted/a/memory.max", "1000");
  write("mounted/a/b/memory.max", "3000");
  write("mounted/a/b/c/memory.max", "2000");
  EXPECT_EQ(limit(), 1000U);
}

TEST_F(Cgroup, InVersionOneTheMemoryHierarchyCounts) {
  write("groups", "5:cpu,cpuacct:/quick\n4:memory:/slurm/uid_1/job_2\n0::/unified");
  write("mounted/memory/memory.limit_in_bytes", "9223372036854771712");
  write("mounted/memory/slurm/uid_1/job_2/memory.limit_in_bytes", "4096");
  write("mounted/memory/quick/memory.limit_in_bytes", "1");
  EXPECT_EQ(limit(), 4096U);
}

TEST_F(Cgroup, TheRootOfAContainerCountsIfThePathDoesNotExist) {
  write("groups", "0::/docker/0123456789abcdef");
  write("mounted/memory.max", "5000");
  EXPECT_EQ(limit(), 5000U);
}

TEST_F(Cgroup, WithoutGroupsThereIsNoLimit) {
  EXPECT_EQ(limit(), UINT64_MAX);
}

}  // namespace
}  // namespace svdag
