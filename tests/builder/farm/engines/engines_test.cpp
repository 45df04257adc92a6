// The engines with fake programs: what is run, when, and how failures are handled.
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "builder/farm/engines/farm_engine.h"
#include "builder/farm/engines/run_local.h"
#include "streaming/process/child_process.h"
#include "streaming/process/shell.h"
#include "streaming/spill/scratch_dir.h"
#include "tests/builder/farm/plans.h"
#include "tests/temp_folder.h"

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
  // The last argument of each command that was started, one per line.
  std::string started_commands() const { return read_bytes(folder_.file("commands")); }
  ptrdiff_t start_count(const std::string& shard) const {
    std::istringstream lines(started_commands());
    return std::count(std::istream_iterator<std::string>(lines), {}, shard);
  }
  // The sbatch calls of submit(); the id of a job is the number of its call, from 1.
  std::vector<std::string> submitted(const SubmitConfig& config = {}) const {
    const std::string log = folder_.file("commands");
    std::filesystem::remove(log);
    program("sbatch", "echo \"$@\" >> " + log + "; wc -l < " + log);
    submit(config);
    std::istringstream lines(started_commands());
    std::vector<std::string> jobs;
    for (std::string line; std::getline(lines, line);) jobs.push_back(line);
    return jobs;
  }
  void submit(SubmitConfig config) const {
    const std::string path = std::getenv("PATH");
    setenv("PATH", (folder_.path() + ":" + path).c_str(), 1);
    const std::shared_ptr<void> after(nullptr, [&](void*) { setenv("PATH", path.c_str(), 1); });
    config.quiet = true;
    submit_slurm(plan_, config);
  }
  void run(const std::string& script) const {
    RunLocalConfig config;
    config.program = program("svdag", "echo \"$4\" >> " + folder_.file("commands") + "\n" + script);
    config.processes = 2;
    config.quiet = true;
    run_local(plan_, config);
  }

  TempFolder folder_;
  Plan plan_;
};

TEST_F(Engines, RunEveryStepAfterItsInputs) {
  run("");
  const std::string lines = started_commands();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), ptrdiff_t(plan_.steps.size()));
  EXPECT_LT(lines.find("shard-1\n"), lines.find("merge-1"));
  EXPECT_LT(lines.find("merge-1"), lines.find("merge-3"));
  EXPECT_LT(lines.find("merge-2"), lines.find("merge-3"));
}

TEST_F(Engines, RetryTemporaryFailuresOnce) {
  const std::string flag = folder_.file("flag");
  run("[ \"$4\" != shard-2 ] || [ -e " + flag + " ] || { touch " + flag + "; exit 4; }");
  const std::string lines = started_commands();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), ptrdiff_t(plan_.steps.size()) + 1);
}

TEST_F(Engines, CountNoAttemptWhileAnotherProcessRunsTheStep) {
  run("[ \"$4\" != shard-2 ] || [ $(grep -c '^shard-2$' " + folder_.file("commands") + ") = 4 ] || exit 75");
  EXPECT_EQ(start_count("shard-2"), 4);
}

TEST_F(Engines, RunOtherStepsWhileAnotherProcessRunsOne) {
  std::optional<ScratchDir> others(plan_.path(plan_.steps[0].output) + ".scratch");
  const std::jthread end([&] {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (start_count("merge-2") == 0 && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    others.reset();
  });
  run("");
  const std::string lines = "\n" + started_commands();
  EXPECT_GT(lines.find("\nshard-1\n"), lines.find("\nmerge-2\n")) << lines;
  EXPECT_EQ(start_count("shard-1"), 1) << "no process is started only to wait";
}

// Shard 2 fails each time just after another process has started it.
TEST_F(Engines, CountAttemptsThatFailWhileAnotherProcessStartsTheStep) {
  const std::string scratch = plan_.path(plan_.steps[1].output) + ".scratch";
  const std::string owner = scratch + "/owner";
  const std::string tries = "$(grep -c '^shard-2$' " + folder_.file("commands") + ")";
  EXPECT_SVDAG_ERROR(run("[ \"$4\" = shard-2 ] && [ " + tries + " -le 5 ] || exit 0\n" +  //
                         "mkdir -p " + scratch + "\n" +                             //
                         "flock " + owner + " sleep 1 &\n" +                        //
                         "while flock -n " + owner + " true; do :; done\n" +        //
                         "exit 4"),
                     ExitCode::kOutput, "shard-2 failed");
  EXPECT_EQ(start_count("shard-2"), 2);
}

TEST_F(Engines, RejectTemplatesWithInvalidUtf8) {
  Plan moved = plan_;
  moved.folder += "/caf\xe9";
  EXPECT_SVDAG_ERROR(openjd_template(moved, {}), ExitCode::kUsage, "is not valid UTF-8");
  EXPECT_SVDAG_ERROR(openjd_template(plan_, {"", "/scratch/\xff"}), ExitCode::kUsage,
                     "is not valid UTF-8");
  const auto here = std::filesystem::current_path();
  std::filesystem::create_directory(folder_.file("caf\xe9"));
  std::filesystem::current_path(folder_.file("caf\xe9"));
  EXPECT_SVDAG_ERROR(openjd_template(plan_, {"", "spill"}), ExitCode::kUsage,
                     "is not valid UTF-8");
  std::filesystem::current_path(here);
}

TEST_F(Engines, SkipDependentsOfAFailedStepAndReportIt) {
  EXPECT_SVDAG_ERROR(run("[ \"$4\" != shard-2 ] || { echo 'svdag: it is broken' >&2; exit 3; }"),
                     ExitCode::kBadInput, "shard-2 failed: it is broken");
  const std::string lines = started_commands();
  EXPECT_NE(lines.find("merge-2"), std::string::npos) << "merge-2 does not need shard-2";
  EXPECT_EQ(lines.find("merge-1"), std::string::npos);
  EXPECT_EQ(lines.find("merge-3"), std::string::npos);
}

TEST_F(Engines, FailAStepThatFailsTwice) {
  EXPECT_SVDAG_ERROR(run("[ \"$4\" != shard-1 ] || kill -9 $$"), ExitCode(128 + 9),
                     "shard-1 failed: killed by signal 9, often for lack of memory");
}

TEST_F(Engines, ReportOnlyMessagesOfThisRun) {
  EXPECT_SVDAG_ERROR(run("[ \"$4\" != shard-1 ] || { echo 'svdag: it is broken'; exit 3; }"),
                     ExitCode::kBadInput, "shard-1 failed: it is broken");
  EXPECT_SVDAG_ERROR(run("[ \"$4\" != shard-1 ] || kill -11 $$"), ExitCode(128 + 11),
                     "shard-1 failed: killed by signal 11 (");
  EXPECT_SVDAG_ERROR(run("[ \"$4\" != shard-1 ] || exit 3"), ExitCode::kBadInput,
                     "shard-1 failed: no message, exit code 3 (");
}

TEST_F(Engines, CreateFoldersThatACopyOfAPlanLacks) {
  for (const char* name : {"logs", "runs"}) std::filesystem::remove_all(plan_.path(name));
  run("");
  EXPECT_TRUE(std::filesystem::exists(plan_.path("logs/shard-1.log")));
  std::filesystem::remove_all(plan_.path("logs"));
  EXPECT_EQ(submitted().size(), 4u);
  EXPECT_TRUE(std::filesystem::exists(plan_.path("logs/merge-1.sh")));
  do_steps(plan_);
}

TEST_F(Engines, NameTheLogThatCannotBeWritten) {
  std::filesystem::create_directory(plan_.path("logs/shard-1.log"));
  EXPECT_SVDAG_ERROR(run(""), ExitCode::kOutput, "logs/shard-1.log: cannot be opened: ");
}

TEST_F(Engines, SubmitAnArrayOfShardsAndMergesWithDependencies) {
  SubmitConfig config;
  config.options = {"--partition=bake"};
  const std::vector<std::string> jobs = submitted(config);
  ASSERT_EQ(jobs.size(), 4u);
  EXPECT_NE(jobs[0].find("--array=1-4 --partition=bake"), std::string::npos) << jobs[0];
  EXPECT_NE(jobs[0].find("--mem="), std::string::npos);
  EXPECT_NE(jobs[1].find("--dependency=afterok:1_1:1_2 --kill-on-invalid-dep=yes"),
            std::string::npos)
      << jobs[1];
  EXPECT_NE(jobs[3].find("--dependency=afterok:2:3 "), std::string::npos) << jobs[3];
}

TEST_F(Engines, SubmitOnlyMissingSteps) {
  for (const size_t i : {0, 1, 3}) do_step(plan_, plan_.steps[i]);
  do_step(plan_, find_step(plan_, "merge-1"));
  const std::vector<std::string> jobs = submitted();
  ASSERT_EQ(jobs.size(), 3u);
  EXPECT_NE(jobs[0].find("--array=3 "), std::string::npos) << jobs[0];
  EXPECT_NE(jobs[1].find("afterok:1_3 "), std::string::npos) << jobs[1];
}

// The value of the first word of `line` that begins with `option`; "none" without one.
std::string value_of(const std::string& line, const std::string& option) {
  const size_t at = line.find(option);
  return at == std::string::npos
             ? "none"
             : line.substr(at + option.size(), line.find(' ', at) - at - option.size());
}

class LargePlans : public Engines {
 protected:
  // Makes a plan that is never run.
  void prepare(size_t shards) {
    PlanConfig config = plan_config(folder_.file("scene.stl"), 5, folder_.file("large"), shards);
    config.fan_in = 1000;
    plan_ = plan_of(config);
  }
  // The output of task `task` of the job that the sbatch call `line` submits.
  std::string run_by(const std::string& line, const std::string& task) const {
    const std::string script = line.substr(line.find_last_of(' ') + 1);
    return run_process({"env", "SLURM_ARRAY_TASK_ID=" + task, "sh", script}).output;
  }
};

TEST_F(LargePlans, UseArraysOfAThousandWithoutAReportedLimit) {
  prepare(2005);
  program("scontrol", "exit 1");
  SubmitConfig config;
  config.program = "echo";
  const std::vector<std::string> jobs = submitted(config);
  ASSERT_EQ(jobs.size(), 3u + 4u) << "arrays, and merges of 3 + 1";
  EXPECT_EQ(value_of(jobs[0], "--array="), "1-999");
  EXPECT_EQ(value_of(jobs[1], "--array="), "0-999");
  EXPECT_EQ(value_of(jobs[2], "--array="), "0-5");
  const std::string shard = "run " + plan_.folder + " --step shard-";
  EXPECT_EQ(run_by(jobs[0], "999"), shard + "999\n");
  EXPECT_EQ(run_by(jobs[1], "0"), shard + "1000\n");
  EXPECT_EQ(run_by(jobs[2], "5"), shard + "2005\n");
  EXPECT_EQ(value_of(jobs[0], "--output="), plan_.path("logs/shard-%a.slurm.log"));
  EXPECT_EQ(value_of(jobs[1], "--output="), plan_.path("logs/shard-1%3a.slurm.log"));
  const std::string last =
      value_of(jobs[5], "--dependency=");  // of the merge that reads shard-2005
  EXPECT_NE((last + ":").find(":3_5:"), std::string::npos) << last;
}

TEST_F(LargePlans, UseArraysWithinTheLimitOfSlurm) {
  prepare(25);
  program("scontrol", "echo 'Slurm data'; echo 'MaxArraySize            = 55'");
  const std::vector<std::string> jobs = submitted();
  ASSERT_EQ(jobs.size(), 3u + 1u);
  EXPECT_EQ(value_of(jobs[0], "--array="), "1-9");
  EXPECT_EQ(value_of(jobs[2], "--array="), "0-5");
}

TEST_F(LargePlans, UseAJobPerShardIfSlurmHasNoArrays) {
  prepare(3);
  program("scontrol", "echo 'MaxArraySize            = 0'");
  SubmitConfig config;
  config.program = "echo";
  const std::vector<std::string> jobs = submitted(config);
  ASSERT_EQ(jobs.size(), 3u + 1u);
  EXPECT_EQ(value_of(jobs[1], "--array="), "none");
  EXPECT_EQ(run_by(jobs[1], ""), "run " + plan_.folder + " --step shard-2\n");
  EXPECT_EQ(value_of(jobs[3], "--dependency="), "afterok:1:2:3");
}

TEST_F(Engines, ReportTheErrorOfSbatch) {
  program("sbatch", "echo 'sbatch: error: no such partition' >&2; exit 1");
  EXPECT_SVDAG_ERROR(submit({}), ExitCode::kOutput, "no such partition");
}

TEST_F(Engines, ReportQueuedJobsWhenSbatchRejectsTheRest) {
  program("sbatch",
          "for last; do :; done\n"
          "case $last in *merge-2*) exit 1;; *merge-1*) echo 8;; *) echo 7;; esac\n");
  ::testing::internal::CaptureStderr();
  EXPECT_SVDAG_ERROR(submit({}), ExitCode::kOutput, "sbatch rejected merge-2");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "svdag: submitted jobs stay queued: list them with squeue --jobs=7,8, cancel them with "
            "scancel 7 8\n");
}

TEST_F(Engines, EscapeAPercentSignInPathsOfLogs) {
  const std::string folder = folder_.file("50%away");
  std::filesystem::rename(plan_.folder, folder);
  plan_.folder = folder;
  const std::vector<std::string> jobs = submitted();
  ASSERT_EQ(jobs.size(), 4u);
  EXPECT_NE(jobs[0].find("/50%%away/logs/shard-%a.slurm.log "), std::string::npos) << jobs[0];
}

TEST_F(Engines, GiveOtherHostsAbsolutePaths) {
  const auto described = [&](const std::string& program, const std::string& scratch) {
    SubmitConfig config;
    config.program = program;
    config.scratch = scratch;
    config.template_path = plan_.path("openjd.json");
    const auto json = nlohmann::json::parse(openjd_template(plan_, config));
    const auto arguments = json["steps"][0]["script"]["actions"]["onRun"]["args"];
    EXPECT_EQ(arguments.back(), "--scratch={{Param.Scratch}}");
    return std::pair<std::string, std::string>(json["parameterDefinitions"][1]["default"],
                                               json["parameterDefinitions"][2]["default"]);
  };
  const std::string here = std::filesystem::current_path().string() + "/";
  EXPECT_EQ(described("bin/svdag", "spill"), std::pair(here + "bin/svdag", here + "spill"));
  EXPECT_EQ(described("svdag", "/spill"), std::pair(std::string("svdag"), std::string("/spill")));
  EXPECT_EQ(described("svdag", "/link/../spill").second, "/link/../spill");  // /link of the host
}

// In a template "{{x}}" is a variable, except in default values of parameters.
TEST_F(Engines, WriteNoVariablesFromNamesIntoATemplate) {
  for (const std::string& name : {std::string("{{city}}.svdag"), std::string(130, 'a')}) {
    plan_.steps.back().output = name;
    const auto json = nlohmann::json::parse(openjd_template(plan_, {"", "/a {{b}}"}));
    EXPECT_EQ(json["name"], "svdag");
    EXPECT_EQ(json["steps"].dump().find("{{b"), std::string::npos);
    EXPECT_EQ(json["parameterDefinitions"][2]["default"], "/a {{b}}");
  }
}

TEST_F(Engines, GiveSlurmNodesAbsolutePaths) {
  SubmitConfig config;
  config.program = "bin/svdag";
  config.scratch = "spill";
  const std::string job = submitted(config).at(0);
  const std::string script = read_bytes(job.substr(job.find_last_of(' ') + 1));
  const std::string here = std::filesystem::current_path().string() + "/";
  EXPECT_NE(script.find("\n" + here + "bin/svdag run "), std::string::npos) << script;
  EXPECT_NE(script.find(" --scratch " + here + "spill\n"), std::string::npos) << script;
}

TEST_F(Engines, WriteATemplateStepPerStage) {
  SubmitConfig config;
  config.template_path = plan_.path("openjd.json");
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

TEST(Shell, QuotedWordsAreReadBackUnchanged) {
  for (const std::string word : {"plain", "a b", "it's", "$HOME", "", "a\\b\"c", "*"})
    EXPECT_EQ(run_process({"sh", "-c", "printf %s " + shell_word(word)}).output, word);
}

TEST(Process, MissingProgramIsAnError) {
  EXPECT_SVDAG_ERROR(run_process({"/no/such/program"}), ExitCode::kOutput, "cannot be started");
  EXPECT_EQ(run_process({"sh", "-c", "kill -9 $$"}).code, 137);
}

}  // namespace
}  // namespace svdag
