class Error(Exception):
    """What svdag refuses or cannot do: one sentence.

    code: the exit code that the programs would have: 1 differs, 2 usage, 3 bad input, 4 disk or output, 5 memory.
    path: the file that it is about, or "".
    """

    def __init__(self, sentence: str, code: int = 2, path: str = ""):
        super().__init__(sentence)
        self.code = code
        self.path = path
