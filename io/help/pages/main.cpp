// svdag-manual: writes man pages and completions, at build time.
//
//   svdag-manual FOLDER FILE...    FILE: a table printed by a program, or a help topic (.txt)
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/help/pages/completion.h"
#include "io/help/pages/man_page.h"
#include "streaming/process/program.h"

namespace svdag {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  if (text.str().empty()) throw Error(ExitCode::kBadInput, path.string() + ": cannot be read");
  return text.str();
}

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw Error(ExitCode::kOutput, path.string() + ": cannot be written");
}

struct Sources {
  std::vector<Manual> programs;
  std::vector<std::string> topics;
};

// Adds a program, or replaces a command: the manual of `svdag export` is that of svdag-export, and
// the table of svdag contains only its name and description.
void add(Manual manual, std::vector<Manual>* programs) {
  for (Manual& program : *programs) {
    for (Manual& command : program.commands) {
      if (command.command != manual.command) continue;
      manual.text = command.text;
      command = std::move(manual);
      return;
    }
  }
  programs->push_back(std::move(manual));
}

Sources read(int argc, char** argv) {
  Sources sources;
  for (int i = 2; i < argc; ++i) {
    const fs::path path = argv[i];
    const std::string text = text_of(path);
    if (path.extension() == ".txt") {
      sources.topics.push_back(text);
      continue;
    }
    for (Manual& program : from_table(text)) add(std::move(program), &sources.programs);
  }
  return sources;
}

// Every page refers to all programs and topics; the page of a program also to its commands.
PageConfig page_config(const Sources& sources, const std::string& page) {
  PageConfig config = {"svdag " SVDAG_VERSION, {}};
  for (const Manual& program : sources.programs) config.see_also.push_back(program.command + "(1)");
  for (const Manual& program : sources.programs) {
    if (program.command != page) continue;
    for (const Manual& command : program.commands)
      config.see_also.push_back(page_of(command.command) + "(1)");
  }
  for (const std::string& topic : sources.topics)
    config.see_also.push_back("svdag-" + topic_name(topic) + "(7)");
  std::erase_if(config.see_also,
                [&](const std::string& other) { return other.substr(0, other.find('(')) == page; });
  return config;
}

void write_pages(const Sources& sources, const fs::path& folder) {
  const auto write_command = [&](const Manual& manual) {
    const std::string page = page_of(manual.command);
    write(folder / "man/man1" / (page + ".1"), command_page(manual, page_config(sources, page)));
  };
  for (const Manual& program : sources.programs) {
    write_command(program);
    for (const Manual& command : program.commands) write_command(command);
  }
  for (const std::string& text : sources.topics) {
    const std::string page = "svdag-" + topic_name(text);
    write(folder / "man/man7" / (page + ".7"), topic_page(text, page_config(sources, page)));
  }
}

void write_completions(const Sources& sources, const fs::path& folder) {
  for (const Manual& program : sources.programs) {
    write(folder / "bash-completion/completions" / program.command, bash_completion(program));
    write(folder / "fish/vendor_completions.d" / (program.command + ".fish"),
          fish_completion(program));
  }
  write(folder / "zsh/site-functions/_svdag", zsh_completion(sources.programs));
}

int run(int argc, char** argv) {
  if (argc < 3) fail_usage("usage: svdag-manual FOLDER FILE...");
  const Sources sources = read(argc, argv);
  write_pages(sources, argv[1]);
  write_completions(sources, argv[1]);
  return 0;
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  return svdag::run_program({"svdag-manual"}, [&] { return svdag::run(argc, argv); });
}
