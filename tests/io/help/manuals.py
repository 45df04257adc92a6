"""What the programs say about themselves: their manuals, as tables (io/help/manual.h)."""
import dataclasses
import re
import subprocess

PROGRAMS = ["svdag", "svdag-export", "svdag-import", "svdag-verify", "svdag-trace"]


@dataclasses.dataclass
class Option:
    names: list
    value: str
    choices: list
    endings: list
    text: str


@dataclasses.dataclass
class Command:
    name: str
    operands: list = dataclasses.field(default_factory=list)
    options: list = dataclasses.field(default_factory=list)
    notes: list = dataclasses.field(default_factory=list)

    def names(self):
        return {name for option in self.options for name in option.names}

    def page(self):
        return self.name.replace(" ", "-")


def commands(programs):
    """{"svdag build": Command}; those of svdag-export and svdag-import as commands of svdag."""
    found = {}
    for program in PROGRAMS:
        table = subprocess.run([programs / program, "--manual-table"], check=True, capture_output=True, text=True).stdout
        for line in table.splitlines():
            kind, *fields = line.split("\t")
            if kind in ("program", "command"):
                command = found[fields[0]] = Command(fields[0])
            elif kind == "note":
                command.notes.append(fields[0])
            else:
                names, value, _, choices, endings, _, _, text = fields
                option = Option(names.split(), value, choices.split(), endings.split(" ") if endings else [], text)
                (command.operands if kind == "operand" else command.options).append(option)
    return found


def options_in(title):
    """The option names at the beginning of a line of a manual."""
    found = re.match(r"((?:--?[A-Za-z][\w-]*(?:, )?)+)", title)
    return found.group(1).split(", ") if found else []
