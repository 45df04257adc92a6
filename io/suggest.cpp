#include "io/suggest.h"

#include <algorithm>
#include <cctype>

namespace svdag {
namespace {

std::string did_you_mean(const std::string& guess, const std::string& otherwise) {
  return guess.empty() ? otherwise : "; did you mean " + guess + "?";
}

// The name of an option without its value; "" if the argument is not an option.
std::string option_name(const std::string& argument) {
  const bool is_option =
      argument.size() > 1 && argument[0] == '-' &&
      (argument[1] == '-' || std::isalpha(static_cast<unsigned char>(argument[1])));
  return is_option && argument != "--" ? argument.substr(0, argument.find('=')) : "";
}

bool has_option(const std::vector<std::string>& options, const std::string& option) {
  if (std::find(options.begin(), options.end(), option) != options.end()) return true;
  // -j4 is -j with its value
  return option[1] != '-' &&
         std::find(options.begin(), options.end(), option.substr(0, 2)) != options.end();
}

// The commands of each program. `trace` is not listed for svdag-verify, where it needs a scene: the
// word suggests svdag-trace.
constexpr std::pair<std::string_view, std::string_view> kPrograms[] = {
    {"svdag", "build batch plan run submit merge info query edit export import"},
    {"svdag-verify", "check mesh diff vdb render report"},
    {"svdag-trace", ""},
    {"svdag-scene", ""},
};

// The text between `before` and `after` in `text`; empty if either is missing.
std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const size_t at = text.find(before);
  if (at == std::string::npos) return "";
  const size_t end = text.find(after, at + before.size());
  if (end == std::string::npos) return "";
  return text.substr(at + before.size(), end - at - before.size());
}

// "-r,--resolution,-s,--voxel-size" as "--resolution or --voxel-size".
std::string alternatives(const std::string& names) {
  std::string text;
  for (size_t at = 0; at < names.size();) {
    const size_t end = std::min(names.find(',', at), names.size());
    const std::string name = names.substr(at, end - at);
    if (name.starts_with("--")) text += (text.empty() ? "" : " or ") + name;
    at = end + 1;
  }
  return text;
}

}  // namespace

std::string plain_usage_error(const std::string& message) {
  const std::string name = message.substr(0, message.find(": "));
  if (message.find(": At Most 1 required but received") != std::string::npos)
    return name + ": is given more than once";
  if (message.starts_with(name + ": ") && message.ends_with(" missing"))
    return name + ": the value is missing";
  const std::string choices = alternatives(between(message, "Exactly 1 option from [", "]"));
  if (!choices.empty())
    return (message.ends_with("were given") ? "give only one of " : "give one of ") + choices;
  const std::string few = alternatives(between(message, "at most 1 options be given from [", "]"));
  if (!few.empty()) return "give only one of " + few;
  const std::string option = between(message + "\n", "Could not convert: ", " = ");
  if (!option.empty())
    return option + ": \"" + between(message + "\n", " = ", "\n") + "\" is not a number";
  const std::string extra = between(message + "\n", " not expected: ", "\n");
  if (!extra.empty()) return "unexpected argument: " + extra;
  const size_t excludes = message.find(" excludes ");
  if (excludes != std::string::npos)
    return message.substr(0, excludes) + " cannot be combined with " +
           message.substr(excludes + 10);
  return message;
}

std::string command_of_other_program(std::string_view word) {
  for (const auto& [program, commands] : kPrograms) {
    const std::string name(program);
    if (word == program || "svdag-" + std::string(word) == program) return name;
    for (size_t at = 0; at < commands.size();) {
      const size_t end = std::min(commands.find(' ', at), commands.size());
      if (commands.substr(at, end - at) == word) return name + " " + std::string(word);
      at = end + 1;
    }
  }
  return "";
}

size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) {
    for (size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] =
          std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
  std::string best;
  size_t best_distance = word.size() / 3 + 1;
  for (const std::string& candidate : candidates) {
    // The difference in length is a lower bound of the distance.
    const size_t longer = std::max(word.size(), candidate.size());
    if (longer - std::min(word.size(), candidate.size()) >= best_distance) continue;
    const size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string explain_unknown(const std::string& program, std::span<const CommandWords> commands,
                            std::span<const std::string> arguments) {
  if (arguments.empty()) return "";
  const bool of_program = commands.size() == 1 || !option_name(arguments[0]).empty();
  const std::string name = of_program ? "" : arguments[0];
  const std::string whole = of_program ? program : program + " " + name;
  std::vector<std::string> names;
  const CommandWords* command = nullptr;
  for (const CommandWords& c : commands) {
    if (c.name == name) command = &c;
    if (!c.name.empty()) names.push_back(c.name);
  }
  if (command == nullptr) {
    if (of_program) return "";
    const std::string other = command_of_other_program(name);
    return "unknown command \"" + name + "\" of " + program +
           did_you_mean(other.empty() ? nearest(name, names) : other,
                        "; see " + program + " --help");
  }
  for (const std::string& argument : arguments.subspan(of_program ? 0 : 1)) {
    if (argument == "--") break;
    const std::string option = option_name(argument);
    if (option.empty() || has_option(command->options, option)) continue;
    return "unknown option " + option + " of " + whole +
           did_you_mean(nearest(option, command->options), "; see " + whole + " --help");
  }
  return "";
}

}  // namespace svdag
