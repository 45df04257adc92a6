import re


class Error(Exception):
    """What svdag refuses or cannot do: one sentence.

    code: the exit code that the programs would have: 1 differs, 2 usage, 3 bad input, 4 disk or output, 5 memory.
    path: the file that it is about, or "".
    """

    def __init__(self, sentence: str, code: int = 2, path: str = ""):
        super().__init__(sentence)
        self.code = code
        self.path = path


class ArgumentError(Error, ValueError):
    """An argument that svdag refuses."""


def error_of(sentence: str, code: int, path: str = "") -> Error:
    """The Error of a program's sentence. Options are named as arguments here: --voxel-size is voxel_size."""
    sentence = re.sub(r"; see svdag[\w -]* --help$", "", sentence)
    sentence = re.sub(r"(?<!svdag info )--([a-z][a-z-]*)", lambda option: option[1].replace("-", "_"), sentence)
    return (ArgumentError if code == 2 else Error)(sentence, code, path)
