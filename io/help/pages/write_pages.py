#!/usr/bin/env python3
"""Writes man pages, and completions for bash, zsh and fish, at build time.

    write_pages.py FOLDER VERSION FILE...    FILE: a manual that a program printed (.json), or a help topic (.txt)

The completion scripts are self-contained, so they can be sourced or installed in the shell's folder.
"""
import json
import pathlib
import re
import sys


def groups(options):
    """{heading: options}, in order of first appearance."""
    found = {}
    for option in options:
        found.setdefault(option["group"], []).append(option)
    return found


def word_of(command):
    """"build" of "svdag build"; "" for a program."""
    return command["command"].partition(" ")[2]


def page_of(command):
    return command["command"].replace(" ", "-")


def function_of(command):
    return "_" + page_of(command).replace("-", "_")


def quoted(text):
    """In single quotes, for sh."""
    return "'" + text.replace("'", "'\\''") + "'"


# Man pages in the macros of man(7): section 1 for commands, section 7 for topics.

ROFF = str.maketrans({"\\": "\\e", "-": "\\-", "'": "\\(aq", '"': "\\(dq", "^": "\\(ha", "~": "\\(ti", "`": "\\(ga"})


def roff(text):
    """A minus that can be copied, straight quotes, and no line that begins like a macro."""
    return ("\\&" if text.startswith(".") else "") + text.translate(ROFF)


def bold(text):
    return f"\\fB{roff(text)}\\fR"


def italic(text):
    return f"\\fI{roff(text)}\\fR"


def heading(title):
    return f'.SH "{roff(title.upper())}"\n'


def top(page, section, what, version):
    what = (what[:1].lower() + what[1:]).removesuffix(".")
    return (f'.TH "{roff(page.upper())}" {section} "" "{roff(version)}" "svdag manual"\n' + heading("Name") +
            f"{roff(page)} \\- {roff(what)}\n")


def entry(option):
    names = ", ".join(bold(name) if name.startswith("-") else italic(name) for name in option["names"])
    value = " " + italic(option["value"]) if option["value"] else "..." if option["repeated"] else ""
    return f".TP\n{names}{value}\n{roff(option['text'])}\n"


def paragraphs(text):
    """(kind, lines) of notes or a topic, as paragraphs_of() in io/help/manual.cpp."""
    for paragraph in re.split(r"\n\n+", text.strip("\n")):
        lines = paragraph.split("\n")
        if re.fullmatch(r"[A-Z][A-Za-z ]{0,29}:", lines[0]):
            yield "heading", [lines.pop(0)[:-1]]
        while lines:
            count = 1
            while count < len(lines) and lines[count].startswith(" ") == lines[0].startswith(" "):
                count += 1
            chunk, lines = lines[:count], lines[count:]
            yield ("lines", chunk) if chunk[0].startswith(" ") else ("text", [" ".join(chunk)])


def body(text, section=None):
    """Paragraphs before the first heading belong to `section`."""
    out, headed = "", False
    for kind, lines in paragraphs(text):
        exit_codes = lines[0].startswith("Exit codes: ")
        wanted = section
        if kind == "heading":
            wanted, headed = "Examples" if lines[0] == "Example" else lines[0], True
        elif kind == "text":
            wanted = "Exit status" if exit_codes else "Notes" if headed or section is None else section
        if wanted != section:
            out += heading(wanted)
            section = wanted
        if kind == "lines":
            indent = len(lines[0]) - len(lines[0].lstrip())
            shown = [line[min(indent, len(line) - len(line.lstrip())):] for line in lines]
            out += ".PP\n.RS 4\n.nf\n" + "".join(roff(line) + "\n" for line in shown) + ".fi\n.RE\n"
        elif exit_codes:
            out += roff(lines[0].removeprefix("Exit codes: ")) + "\n"
        elif kind == "text":
            out += f".PP\n{roff(lines[0])}\n"
    return out


def see_also(pages):
    return heading("See also") + ",\n".join(f".BR {roff(name)} ({section})" for name, section in pages) + "\n"


def command_page(command, version, others):
    text = command["text"]
    out = top(page_of(command), 1, text, version)
    out += heading("Synopsis") + f"{bold(command['command'])} {roff(command['usage'])}\n"
    out += heading("Description") + roff(text.removesuffix(".")) + ".\n"
    out += "".join(map(entry, command["operands"]))
    if command["commands"]:
        out += heading("Commands")
    for each in command["commands"]:
        out += f".TP\n{bold(word_of(each))}\n{roff(each['text'])}\n"
    for group, options in groups(command["options"]).items():
        out += heading(group or "Options") + "".join(map(entry, options))
    return out + body(command["notes"]) + see_also(others)


def topic_page(text, version, others):
    title, _, rest = text.partition("\n")
    name, _, what = title.partition(": ")
    return (top(f"svdag-{name}", 7, what, version) + heading("Description") + body(rest, "Description") +
            see_also(others))


def write_man_pages(folder, version, programs, topics):
    """Every page refers to all programs and topics; the page of a program also to its commands."""
    topic_names = [text.partition(":")[0] for text in topics]

    def others(page, commands=()):
        names = [(page_of(each), 1) for each in [*programs, *commands]] + [(f"svdag-{name}", 7) for name in topic_names]
        return [each for each in names if each[0] != page]

    for program in programs:
        for command in [program, *program["commands"]]:
            page = page_of(command)
            write(folder / "man1" / f"{page}.1", command_page(command, version, others(page, command["commands"])))
    for name, text in zip(topic_names, topics):
        write(folder / "man7" / f"svdag-{name}.7", topic_page(text, version, others(f"svdag-{name}")))


# bash 4 or later

BASH = r"""
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
"""


def bash_kind(option):
    """The value of the script's variable `kind` for an option or operand."""
    if option["choices"]:
        return "words " + " ".join(option["choices"])
    if option["endings"]:
        return "files " + " ".join(ending for ending in option["endings"] if ending != "*")
    return "value"


def bash_completion(program):
    kinds = options = ""
    for command in [program, *program["commands"]]:
        word = word_of(command)
        for option in command["options"]:
            if option["value"]:
                patterns = "|".join(f'"{word} {name}"' for name in option["names"])
                kinds += f"    {patterns}) kind={quoted(bash_kind(option))} ;;\n"
        for number, operand in enumerate(command["operands"]):
            pattern = f'"{word} "[0-9]*' if operand["repeated"] else f'"{word} {number}"'
            kinds += f"    {pattern}) kind={quoted(bash_kind(operand))} ;;\n"
        names = " ".join(name for option in command["options"] for name in option["names"])
        options += f"    {quoted(word)}) options={quoted(names)} ;;\n"
    commands = f" {' '.join(map(word_of, program['commands']))} "
    text = (f"# Completion of {program['command']} for bash.\n\n"
            "# Sets kind: what an option, or the operand of a number, takes.\n"
            f'@_kind() {{\n  kind=\n  case "$1 $2" in\n{kinds}  esac\n}}\n\n'
            f"# Sets options: the options of a command.\n@_options() {{\n  case $1 in\n{options}  esac\n}}\n" + BASH +
            f"\ncomplete -F @ {program['command']}\n")
    return text.replace("@COMMANDS", commands).replace("@", function_of(program))


# zsh: one function _svdag for all programs

def zsh_escaped(text):
    """The brackets and colons of a specification of _arguments."""
    return re.sub(r"[\[\]:\\]", r"\\\g<0>", text)


def zsh_value(name, option):
    """":N:(thin conservative)": the name of a value and its completions."""
    action = ""
    if option["choices"]:
        action = f"({' '.join(option['choices'])})"
    elif option["endings"] == ["/"]:
        action = "_files -/"
    elif option["endings"] == ["*"]:
        action = "_files"
    elif option["endings"]:
        action = f'_files -g "(#i)*.({"|".join(ending[1:] for ending in option["endings"])})(-.)"'
    return f":{zsh_escaped(name)}:{action}"


def zsh_specifications(command):
    """A specification per name of an option. It excludes the other names unless the option may be repeated."""
    specs = []
    for option in command["options"]:
        for name in option["names"]:
            spec = "*" if option["repeated"] else f"({' '.join(option['names'])})"
            spec += name + (("=" if name.startswith("--") else "+") if option["value"] else "")
            spec += f"[{zsh_escaped(option['text'])}]"
            specs.append(spec + (zsh_value(option["value"], option) if option["value"] else ""))
    for operand in command["operands"]:
        prefix = "*" if operand["repeated"] else "" if operand["required"] else ":"
        specs.append(prefix + zsh_value(operand["names"][0], operand))
    return "".join(f" \\\n    {quoted(spec)}" for spec in specs)


def zsh_function(name, command):
    return f"{name}() {{\n  _arguments -s -S{zsh_specifications(command)}\n}}\n\n"


def zsh_dispatcher(name, program):
    """The first word selects the function that completes the rest."""
    described = "".join(f"    {quoted(word_of(each) + ':' + zsh_escaped(each['text']))}\n" for each in program["commands"])
    cases = "".join(f"        {word_of(each)}) {function_of(each)} ;;\n" for each in program["commands"])
    return f"""{name}() {{
  local curcontext=$curcontext state line
  local -a commands
  commands=(
{described}  )
  _arguments -C{zsh_specifications(program)} \\
    '1:command:->command' '*::argument:->rest'
  case $state in
    command) _describe -t commands command commands ;;
    rest)
      case $words[1] in
{cases}      esac
      ;;
  esac
}}

"""


def zsh_completion(programs):
    functions = cases = ""
    for program in programs:
        name = function_of(program) + "_commands"  # _svdag is the function of this file
        functions += "".join(zsh_function(function_of(each), each) for each in program["commands"])
        functions += zsh_dispatcher(name, program) if program["commands"] else zsh_function(name, program)
        cases += f"  {program['command']}) {name} \"$@\" ;;\n"
    names = " ".join(program["command"] for program in programs)
    return f"#compdef {names}\n# Completion for zsh.\n\n{functions}case $service in\n{cases}esac\n"


# fish 3

FISH = r"""
# Whether the command is one of these words.
function @_is
    set -l words (commandline -opc)
    set -q words[2]; and contains -- $words[2] $argv
end

# The value so far: the word, or the part after the = of its option.
function @_value
    string replace -r -- '^--[^=]*=' '' (commandline -ct)
end

# Folders, and files with these endings.
function @_files
    set -l files (complete -C "__fish_command_without_completions "(@_value))
    string match -r -- '^.*/$' $files
    for ending in $argv
        string match -r -- '(?i)^.*'(string escape --style=regex -- $ending)'$' $files
    end
    return 0
end
"""


def fish_quoted(text):
    """In single quotes, fish has two escapes: \\\\ and \\'."""
    return "'" + re.sub(r"['\\]", r"\\\g<0>", text) + "'"


def fish_value(option):
    if option["choices"]:
        return " -x -a " + fish_quoted(" ".join(option["choices"]))
    if option["endings"] == ["/"]:
        return " -x -a '(__fish_complete_directories (@_value))'"
    if option["endings"] == ["*"]:
        return " -r -F"
    return f" -x -k -a '(@_files {' '.join(option['endings'])})'" if option["endings"] else " -x"


def fish_lines(program, command, condition):
    start = f"complete -c {program} -n '{condition}'"
    out = ""
    for option in command["options"]:
        names = "".join(f" -l {name[2:]}" if name.startswith("--") else f" -s {name[1:]}" for name in option["names"])
        value = fish_value(option) if option["value"] else ""
        out += f"{start}{names}{value} -d {fish_quoted(option['text'])}\n"
    for operand in command["operands"]:
        out += start + fish_value(operand).replace(" -x", "") + "\n"
    return out


def fish_completion(program):
    name = program["command"]
    first = "test (count (commandline -opc)) -eq 1" if program["commands"] else "true"
    out = f"# Completion of {name} for fish.\n{FISH}\ncomplete -c {name} -f\n" + fish_lines(name, program, first)
    for command in program["commands"]:
        word = word_of(command)
        out += f"complete -c {name} -n '{first}' -a {word} -d {fish_quoted(command['text'])}\n"
        out += fish_lines(name, command, f"@_is {word}")
    return out.replace("@_", f"_{function_of(program)}_")


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def add(manual, programs):
    """Adds a program, or replaces a command: the manual of `svdag export` is that of svdag-export, and svdag itself has
    only its name and description."""
    for program in programs:
        for command in program["commands"]:
            if command["command"] == manual["command"]:
                command.update(manual, text=command["text"])
                return
    programs.append(manual)


def main():
    folder, version, *files = sys.argv[1:]
    folder = pathlib.Path(folder)
    programs, topics = [], []
    for file in map(pathlib.Path, files):
        if file.suffix == ".txt":
            topics.append(file.read_text())
        else:
            add(json.loads(file.read_text()), programs)
    write_man_pages(folder / "man", version, programs, topics)
    for program in programs:
        write(folder / "bash-completion/completions" / program["command"], bash_completion(program))
        write(folder / "fish/vendor_completions.d" / f"{program['command']}.fish", fish_completion(program))
    write(folder / "zsh/site-functions/_svdag", zsh_completion(programs))


if __name__ == "__main__":
    main()
