#include "builder/farm/plan/plan_folder.h"

#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <set>
#include <system_error>

#include "builder/farm/plan/receipt.h"
#include "streaming/error.h"
#include "streaming/file/system_call.h"

namespace svdag {
namespace {

namespace fs = std::filesystem;

bool belongs_to_plan(const std::string& folder, const std::string& name,
                     const std::string& output) {
  static const std::set<std::string> kCreatedFirst = {"plan.scratch", "runs", "logs"};
  static const std::set<std::string> kCreatedLater = {"index", kPlanTriangles, "openjd.json"};
  // Hidden files are accepted: no step overwrites them.
  if (name.starts_with('.') || kCreatedFirst.contains(name)) return true;
  // runs/ is created before the other files: without it they do not belong to a plan.
  if (!fs::is_directory(folder + "/runs")) return false;
  return kCreatedLater.contains(name) || name == output || name == output + ".scratch";
}

}  // namespace

bool make_folder(const std::string& path) {
  if (::mkdir(path.c_str(), 0777) == 0) return true;
  if (errno == EEXIST) return false;
  fail_call(ExitCode::kOutput, "the folder cannot be created", path, errno);
}

std::vector<std::string> own_files(const std::string& folder) {
  return {folder + "/plan.json", folder + "/index", folder + "/" + kPlanTriangles};
}

std::vector<std::string> files_of(const Plan& plan) {
  std::vector<std::string> files = own_files(plan.folder);
  for (const PlanStep& step : plan.steps) {
    files.push_back(plan.path(step.output));
    files.push_back(receipt_path(plan, step));
  }
  return files;
}

void reject_foreign_files(const std::string& folder, const std::string& output) {
  // If the folder does not exist or cannot be listed, writing to it reports the error.
  std::error_code none;
  for (fs::directory_iterator entry(folder, none), end; !none && entry != end;
       entry.increment(none)) {
    const std::string name = entry->path().filename().string();
    if (!belongs_to_plan(folder, name, output))
      fail_usage(folder + ": contains " + name +
                 ", which is not a file of a plan: choose another folder");
  }
}

}  // namespace svdag
