// The engines, asked with programs that only pretend: what is run, when, and what of failures.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "builder/farm/process.h"
#include "builder/farm/run_local.h"
#include "builder/farm/shell.h"
#include "builder/farm/submit_openjd.h"
#include "builder/farm/submit_slurm.h"
#include "tests/builder/farm/plans.h"

namespace svdag {
namespace {

class Engines : public ::testing::Test {
 protected:
  Engines() {
    write_stl(folder_.file("scene.stl"), bumpy_sphere(20));
    PlanConfig config = plan_config(folder_.file("scene.stl"), 7, folder_.file("plan"), 4);
    config.fan_in = 2;
    plan_ = plan_of(config);
  }
  std::string program(const std::string& name, const std::string& script) const {
    const std::string path = folder_.file(name);
    std::ofstream(path) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return path;
  }
  // The commands that were asked for, a line each.
  std::string asked() const { return read_bytes(folder_.file("asked")); }
  void run(const std::string& script) const {
    RunLocalConfig config;
    config.program = program("svdag", "echo \"$4\" >> " + folder_.file("asked") + "\n" + script);
    config.processes = 2;
    config.quiet = true;
    run_local(plan_, config);
  }

  TemporaryFolder folder_;
  Plan plan_;
};

TEST_F(Engines, RunEveryStepAfterItsInputs) {
  run("");
  const std::string lines = asked();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), ptrdiff_t(plan_.steps.size()));
  EXPECT_LT(lines.find("1\n"), lines.find("merge-1"));
  EXPECT_LT(lines.find("merge-1"), lines.find("merge-3"));
  EXPECT_LT(lines.find("merge-2"), lines.find("merge-3"));
}

TEST_F(Engines, TryAgainOnceWhatMayPass) {
  const std::string flag = folder_.file("flag");
  run("[ \"$4\" != 2 ] || [ -e " + flag + " ] || { touch " + flag + "; exit 4; }");
  const std::string lines = asked();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), ptrdiff_t(plan_.steps.size()) + 1);
}

TEST_F(Engines, LeaveOutWhatCannotBeDoneAndTellWhy) {
  EXPECT_SVDAG_ERROR(run("[ \"$4\" != 2 ] || { echo 'svdag: it is broken' >&2; exit 3; }"),
                     ExitCode::kBadInput, "shard-2 failed: it is broken");
  const std::string lines = asked();
  EXPECT_NE(lines.find("merge-2"), std::string::npos) << "merge-2 does not need shard-2";
  EXPECT_EQ(lines.find("merge-1"), std::string::npos);
  EXPECT_EQ(lines.find("merge-3"), std::string::npos);
}

TEST_F(Engines, GiveUpWhatFailsTwice) {
  EXPECT_SVDAG_ERROR(run("[ \"$4\" != 1 ] || kill -9 $$"), ExitCode(128 + 9), "shard-1");
}

TEST_F(Engines, SubmitAnArrayOfShardsAndMergesThatWaitForTheirs) {
  const std::string log = folder_.file("asked");
  program("sbatch", "echo \"$@\" >> " + log + "; wc -l < " + log);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder_.path() + ":" + path).c_str(), 1);
  SlurmConfig config;
  config.options = {"--partition=bake"};
  config.quiet = true;
  submit_slurm(plan_, config);
  setenv("PATH", path.c_str(), 1);
  std::istringstream lines(asked());
  std::vector<std::string> jobs;
  for (std::string line; std::getline(lines, line);) jobs.push_back(line);
  ASSERT_EQ(jobs.size(), 4u);
  EXPECT_NE(jobs[0].find("--array=1,2,3,4 --partition=bake"), std::string::npos) << jobs[0];
  EXPECT_NE(jobs[0].find("--mem="), std::string::npos);
  EXPECT_NE(jobs[1].find("--dependency=afterok:1_1:1_2 --kill-on-invalid-dep=yes"),
            std::string::npos)
      << jobs[1];
  EXPECT_NE(jobs[3].find("--dependency=afterok:2:3 "), std::string::npos) << jobs[3];
}

TEST_F(Engines, SubmitOnlyWhatIsMissing) {
  for (const size_t i : {0, 1, 3}) do_step(plan_, plan_.steps[i]);
  do_step(plan_, find_step(plan_, "merge-1"));
  const std::string log = folder_.file("asked");
  program("sbatch", "echo \"$@\" >> " + log + "; wc -l < " + log);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder_.path() + ":" + path).c_str(), 1);
  SlurmConfig config;
  config.quiet = true;
  submit_slurm(plan_, config);
  setenv("PATH", path.c_str(), 1);
  const std::string text = asked();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << text;
  EXPECT_NE(text.find("--array=3 "), std::string::npos) << text;
  EXPECT_NE(text.find("afterok:1_3 "), std::string::npos) << text;
}

TEST_F(Engines, SayWhatSbatchSays) {
  program("sbatch", "echo 'sbatch: error: no such partition' >&2; exit 1");
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder_.path() + ":" + path).c_str(), 1);
  EXPECT_SVDAG_ERROR(submit_slurm(plan_, {}), ExitCode::kUsage, "no such partition");
  setenv("PATH", path.c_str(), 1);
}

TEST_F(Engines, DescribeStagesToOpenJobDescription) {
  OpenJdConfig config;
  config.path = plan_.path("openjd.json");
  const auto json = nlohmann::json::parse(openjd_template(plan_, config));
  ASSERT_EQ(json.at("steps").size(), 3u);
  const auto range = [&](size_t i) {
    return json["steps"][i]["parameterSpace"]["taskParameterDefinitions"][0]["range"];
  };
  EXPECT_EQ(range(0), "1-4");
  EXPECT_EQ(range(1), "1-2");
  EXPECT_EQ(range(2), "3-3");
  EXPECT_EQ(json["steps"][2]["dependencies"][0]["dependsOn"], "Merges1");
  EXPECT_EQ(json["parameterDefinitions"][0]["default"], ".");
}

TEST(Shell, WordsAreReadAsTheyWere) {
  for (const std::string word : {"plain", "a b", "it's", "$HOME", "", "a\\b\"c", "*"})
    EXPECT_EQ(ask_process({"sh", "-c", "printf %s " + shell_word(word)}).output, word);
}

TEST(Process, ThatIsNotThereIsAnError) {
  EXPECT_SVDAG_ERROR(ask_process({"/no/such/program"}), ExitCode::kOutput, "cannot be started");
  EXPECT_EQ(ask_process({"sh", "-c", "kill -9 $$"}).code, 137);
}

}  // namespace
}  // namespace svdag
