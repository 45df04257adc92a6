"""What the programs say about themselves: their manuals, as JSON (io/help/manual.h)."""
import dataclasses
import json
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

    def options(rows):
        return [Option(row["names"], row["value"], row["choices"], row["endings"], row["text"]) for row in rows]

    for program in PROGRAMS:
        printed = subprocess.run([programs / program, "--manual-json"], check=True, capture_output=True, text=True).stdout
        manual = json.loads(printed)
        for command in [manual, *manual["commands"]]:
            found[command["command"]] = Command(command["command"], options(command["operands"]),
                                                options(command["options"]), command["notes"].split("\n"))
    return found


def options_in(title):
    """The option names at the beginning of a line of a manual."""
    found = re.match(r"((?:--?[A-Za-z][\w-]*(?:, )?)+)", title)
    return found.group(1).split(", ") if found else []
