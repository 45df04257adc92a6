#!/usr/bin/env python3
"""Writes man pages, and completions for bash, zsh and fish, at build time.

    write_pages.py FOLDER VERSION FILE...    FILE: a manual that a program printed (.json), or a help topic (.txt)

The completion scripts are self-contained, so they can be sourced or installed in the shell's folder.
"""
import json
import pathlib
import re
import sys


def read(files):
    """(programs, {topic: text}). svdag-export prints the manual of `svdag export`; svdag describes it in a line."""
    programs, topics = [], {}
    for file in map(pathlib.Path, files):
        if file.suffix == ".txt":
            topics[file.stem] = file.read_text()
            continue
        manual = json.loads(file.read_text())
        same = [each for program in programs for each in program["commands"] if each["command"] == manual["command"]]
        for each in same:
            each.update(manual, text=each["text"])
        programs += [] if same else [manual]
    for command in [each for program in programs for each in [program, *program["commands"]]]:
        command["word"] = command["command"].partition(" ")[2]  # "build" of "svdag build"; "" for a program
        command["page"] = command["command"].replace(" ", "-")
        command["function"] = "_" + command["page"].replace("-", "_")
    return programs, topics


def quoted(text):
    """In single quotes, for sh."""
    return "'" + text.replace("'", "'\\''") + "'"


# Man pages in the macros of man(7): section 1 for commands, section 7 for topics.

ROFF = str.maketrans({"\\": "\\e", "-": "\\-", "'": "\\(aq", '"': "\\(dq", "^": "\\(ha", "~": "\\(ti", "`": "\\(ga"})


def roff(text, font=None):
    """A minus that can be copied, straight quotes, and no line that begins like a macro."""
    text = ("\\&" if text.startswith(".") else "") + text.translate(ROFF)
    return f"\\f{font}{text}\\fR" if font else text


def heading(title):
    return f'.SH "{roff(title.upper())}"\n'


def entry(title, text):
    return f".TP\n{title}\n{roff(text)}\n"


def option_entry(option):
    title = ", ".join(roff(name, "B" if name.startswith("-") else "I") for name in option["names"])
    title += " " + roff(option["value"], "I") if option["value"] else ""
    return entry(title + ("..." if option["repeated"] else ""), option["text"])


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
    out, headed = "", section is None
    for kind, lines in paragraphs(text):
        is_exit = lines[0].startswith("Exit codes: ")
        wanted = section
        if kind == "heading":
            wanted, headed = "Examples" if lines[0] == "Example" else lines[0], True
        elif kind == "text" and (headed or is_exit):
            wanted = "Exit status" if is_exit else "Notes"
        if wanted != section:
            out += heading(wanted)
            section = wanted
        if kind == "lines":
            indent = len(lines[0]) - len(lines[0].lstrip())
            shown = [line[min(indent, len(line) - len(line.lstrip())):] for line in lines]
            out += ".PP\n.RS 4\n.nf\n" + "".join(roff(line) + "\n" for line in shown) + ".fi\n.RE\n"
        elif kind == "text":
            out += ("" if is_exit else ".PP\n") + roff(lines[0].removeprefix("Exit codes: ")) + "\n"
    return out


def command_body(command):
    out = heading("Synopsis") + f"{roff(command['command'], 'B')} {roff(command['usage'])}\n"
    out += heading("Description") + roff(command["text"].removesuffix(".")) + ".\n"
    out += "".join(map(option_entry, command["operands"]))
    out += heading("Commands") if command["commands"] else ""
    out += "".join(entry(roff(each["word"], "B"), each["text"]) for each in command["commands"])
    groups = {}  # in order of first appearance
    for option in command["options"]:
        groups[option["group"]] = groups.get(option["group"], "") + option_entry(option)
    return out + "".join(heading(group or "Options") + text for group, text in groups.items()) + body(command["notes"])


def write_man_pages(folder, version, programs, topics):
    """Every page refers to all programs and topics; the page of a program also to its commands."""

    def write_page(page, section, what, text, commands=()):
        what = (what[:1].lower() + what[1:]).removesuffix(".")
        others = [(each["page"], 1) for each in [*programs, *commands]] + [(f"svdag-{topic}", 7) for topic in topics]
        others = ",\n".join(f".BR {roff(name)} ({number})" for name, number in others if name != page)
        write(folder / f"man{section}/{page}.{section}",
              f'.TH "{roff(page.upper())}" {section} "" "{roff(version)}" "svdag manual"\n' + heading("Name") +
              f"{roff(page)} \\- {roff(what)}\n{text}{heading('See also')}{others}\n")

    for command in [each for program in programs for each in [program, *program["commands"]]]:
        write_page(command["page"], 1, command["text"], command_body(command), command["commands"])
    for topic, text in topics.items():
        title, _, rest = text.partition("\n")
        write_page(f"svdag-{topic}", 7, title.partition(": ")[2], heading("Description") + body(rest, "Description"))


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
        return quoted("words " + " ".join(option["choices"]))
    return quoted("files " + " ".join(option["endings"]).strip("*") if option["endings"] else "value")


def bash_completion(program):
    kinds = options = ""
    for command in [program, *program["commands"]]:
        word = command["word"]
        for option in command["options"]:
            patterns = "|".join(f'"{word} {name}"' for name in option["names"])
            kinds += f"    {patterns}) kind={bash_kind(option)} ;;\n" if option["value"] else ""
        for number, operand in enumerate(command["operands"]):
            pattern = f'"{word} "[0-9]*' if operand["repeated"] else f'"{word} {number}"'
            kinds += f"    {pattern}) kind={bash_kind(operand)} ;;\n"
        names = " ".join(name for option in command["options"] for name in option["names"])
        options += f"    {quoted(word)}) options={quoted(names)} ;;\n"
    commands = f" {' '.join(each['word'] for each in program['commands'])} "
    return f"""# Completion of {program['command']} for bash.

# Sets kind: what an option, or the operand of a number, takes.
@_kind() {{
  kind=
  case "$1 $2" in
{kinds}  esac
}}

# Sets options: the options of a command.
@_options() {{
  case $1 in
{options}  esac
}}
{BASH}
complete -F @ {program['command']}
""".replace("@COMMANDS", commands).replace("@", program["function"])


# zsh: one function _svdag for all programs

def zsh_escaped(text):
    """The brackets and colons of a specification of _arguments."""
    return re.sub(r"[\[\]:\\]", r"\\\g<0>", text)


def zsh_value(name, option):
    """":N:(thin conservative)": the name of a value and its completions."""
    endings = option["endings"]
    action = f"({' '.join(option['choices'])})" if option["choices"] else "_files" if endings else ""
    if endings == ["/"]:
        action += " -/"
    elif endings and endings != ["*"]:
        action += f' -g "(#i)*.({"|".join(ending[1:] for ending in endings)})(-.)"'
    return f":{zsh_escaped(name)}:{action}"


def zsh_arguments(command):
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
    return f"{name}() {{\n  _arguments -s -S{zsh_arguments(command)}\n}}\n\n"


def zsh_dispatcher(name, program):
    """The first word selects the function that completes the rest."""
    described = [quoted(f"{each['word']}:{zsh_escaped(each['text'])}") for each in program["commands"]]
    cases = "".join(f"        {each['word']}) {each['function']} ;;\n" for each in program["commands"])
    newline = "\n    "
    return f"""{name}() {{
  local curcontext=$curcontext state line
  local -a commands
  commands=(
    {newline.join(described)}
  )
  _arguments -C{zsh_arguments(program)} \\
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
        name = program["function"] + "_commands"  # _svdag is the function of this file
        functions += "".join(zsh_function(each["function"], each) for each in program["commands"])
        functions += (zsh_dispatcher if program["commands"] else zsh_function)(name, program)
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
    known = {"": " -x", "/": " -x -a '(__fish_complete_directories (@_value))'", "*": " -r -F"}
    endings = " ".join(option["endings"])
    return known.get(endings, f" -x -k -a '(@_files {endings})'")


def fish_lines(program, command, condition):
    start = f"complete -c {program['command']} -n '{condition}'"
    out = ""
    for option in command["options"]:
        names = "".join(f" -l {name[2:]}" if name.startswith("--") else f" -s {name[1:]}" for name in option["names"])
        out += start + names + (fish_value(option) if option["value"] else "") + f" -d {fish_quoted(option['text'])}\n"
    return out + "".join(start + fish_value(operand).replace(" -x", "") + "\n" for operand in command["operands"])


def fish_completion(program):
    name = program["command"]
    first = "test (count (commandline -opc)) -eq 1" if program["commands"] else "true"
    out = f"# Completion of {name} for fish.\n{FISH}\ncomplete -c {name} -f\n" + fish_lines(program, program, first)
    for command in program["commands"]:
        word = command["word"]
        out += f"complete -c {name} -n '{first}' -a {word} -d {fish_quoted(command['text'])}\n"
        out += fish_lines(program, command, f"@_is {word}")
    return out.replace("@_", f"_{program['function']}_")


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def main():
    folder, version, *files = sys.argv[1:]
    folder = pathlib.Path(folder)
    programs, topics = read(files)
    write_man_pages(folder / "man", version, programs, topics)
    for program in programs:
        write(folder / "bash-completion/completions" / program["command"], bash_completion(program))
        write(folder / "fish/vendor_completions.d" / f"{program['command']}.fish", fish_completion(program))
    write(folder / "zsh/site-functions/_svdag", zsh_completion(programs))


if __name__ == "__main__":
    main()
