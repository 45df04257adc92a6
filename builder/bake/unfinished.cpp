#include "builder/bake/unfinished.h"

namespace svdag {

std::optional<SavedBake> find_unfinished(const BuildConfig& config, Workspace* workspace,
                                         Checkpoint* checkpoint, Description* description) {
  std::optional<SavedBake> saved;
  if (workspace->has_unfinished_bake()) {
    const auto wanted = [&](const std::string& text) {
      return config.unfinished != Unfinished::kResumeSame || text == description->text();
    };
    if (config.unfinished != Unfinished::kRestart) saved = checkpoint->resume(wanted);
    if (saved && saved->runs.empty() && !saved->split) saved.reset();
    if (!saved) checkpoint->discard();
  }
  if (!saved) {
    workspace->folder()->clear();
    return saved;
  }
  if (config.unfinished == Unfinished::kRefuse)
    fail_usage(config.output + ": an unfinished bake of it is in " + workspace->folder()->path() +
               ": continue it with --resume or discard it with --restart");
  const std::string other = difference(saved->description, description->text());
  if (!other.empty())
    fail_usage(config.output + ": the unfinished bake is another one: " + other +
               "; discard it with --restart");
  return saved;
}

}  // namespace svdag
