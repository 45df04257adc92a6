#include "io/help/pages/completion.h"

namespace svdag {
namespace {

// The value of the script's variable `kind` for an option or operand.
std::string kind_of(const ManualOption& option) {
  if (!option.choices.empty()) return "words " + join_words(option.choices);
  if (takes_any_file(option)) return "files ";
  if (!option.endings.empty()) return "files " + join_words(option.endings);
  return "value";
}

// The cases of one command: its options, then its operands by their number.
std::string cases_of(const Manual& command) {
  const std::string name = name_in_program(command);
  std::string out;
  for (const ManualOption& option : command.options) {
    if (option.value.empty()) continue;
    std::string patterns;
    for (const std::string& each : option.names)
      patterns += (patterns.empty() ? "" : "|") + ("\"" + name + " " + each + "\"");
    out += "    " + patterns + ") kind=" + single_quoted(kind_of(option)) + " ;;\n";
  }
  size_t number = 0;
  for (const ManualOption& operand : command.operands) {
    const std::string which = operand.repeated ? "\"" + name + " \"[0-9]*"
                                               : "\"" + name + " " + std::to_string(number) + "\"";
    out += "    " + which + ") kind=" + single_quoted(kind_of(operand)) + " ;;\n";
    ++number;
  }
  return out;
}

std::string options_of(const Manual& command) {
  std::string out;
  for (const ManualOption& option : command.options) out += join_words(option.names) + " ";
  if (!out.empty()) out.pop_back();
  return "    " + single_quoted(name_in_program(command)) + ") options=" + single_quoted(out) +
         " ;;\n";
}

// @ is replaced by the name of the program's function, @COMMANDS by the list of its commands.
constexpr const char* kEngine = R"sh(
# Offers completions of the current word: choices, or folders and files with the right endings.
@_offer() {
  local kind=$1 name ending
  case $kind in
    words*) COMPREPLY=($(compgen -W "${kind#words }" -- "$cur")) ;;
    files*)
      compopt -o filenames 2>/dev/null
      while IFS= read -r name; do
        if [[ -d ${name/#\~/$HOME} ]]; then
          COMPREPLY+=("$name")
          continue
        fi
        [[ $kind == "files " ]] && COMPREPLY+=("$name")
        for ending in ${kind#files }; do
          [[ ${name,,} == *"$ending" ]] && COMPREPLY+=("$name") && break
        done
      done < <(compgen -f -- "$cur")
      ;;
  esac
}

@() {
  local cur=${COMP_WORDS[COMP_CWORD]}
  local command= number=0 after= option= i word kind options
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    if [[ $after && $word == = ]]; then  # bash splits --rule=thin into three words
      [[ $option == --* ]] || after=value  # -o=city.svdag means a file =city.svdag
    elif [[ $after ]]; then
      after=
    elif [[ $word == -* ]]; then
      @_kind "$command" "$word"
      after=$kind option=$word
    elif [[ -z $command && "@COMMANDS" == *" $word "* ]]; then
      command=$word
    else
      ((++number))
    fi
  done
  if [[ $cur == = ]]; then
    cur=
    [[ $option == --* ]] || after=value
  fi
  if [[ $after ]]; then
    @_offer "$after"
  elif [[ $cur == -* ]]; then
    @_options "$command"
    COMPREPLY=($(compgen -W "$options" -- "$cur"))
  elif [[ -z $command && "@COMMANDS" != "  " ]]; then
    COMPREPLY=($(compgen -W "@COMMANDS" -- "$cur"))
  else
    @_kind "$command" "$number"
    @_offer "$kind"
  fi
}
)sh";

}  // namespace

std::string bash_completion(const Manual& program) {
  std::string function = "_" + replace_all(program.command, "-", "_"), cases, options,
              commands = " ";
  cases = cases_of(program);
  options = options_of(program);
  for (const Manual& command : program.commands) {
    cases += cases_of(command);
    options += options_of(command);
    commands += name_in_program(command) + " ";
  }
  if (program.commands.empty()) commands = "  ";
  std::string out = "# Completion of " + program.command + " for bash.\n\n";
  out += "# Sets kind: what an option, or the operand of a number, takes.\n" + function +
         "_kind() {\n  kind=\n  case \"$1 $2\" in\n" + cases + "  esac\n}\n\n";
  out += "# Sets options: the options of a command.\n" + function + "_options() {\n  case $1 in\n" +
         options + "  esac\n}\n";
  out += replace_all(replace_all(kEngine, "@COMMANDS", commands), "@", function);
  return out + "\ncomplete -F " + function + " " + program.command + "\n";
}

}  // namespace svdag
