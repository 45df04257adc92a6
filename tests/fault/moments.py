"""A bake that is hit by a signal at a random moment of its life."""
import random
import subprocess
import time
from typing import NamedTuple

TIMEOUT = 120


class Ending(NamedTuple):
    code: int  # minus the number of the signal that ended it, else the exit status
    stderr: str
    seconds: float  # from the (last) signal to the end; of the whole bake if it ended before


def time_of(command, cwd):
    start = time.monotonic()
    subprocess.run(command, cwd=cwd, check=True)
    return time.monotonic() - start


def hit(command, cwd, moment, signals):
    """Starts the bake, sends it `signals` after `moment` seconds, a hundredth of a second between them."""
    begin = start = time.monotonic()
    program = subprocess.Popen(command, cwd=cwd, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        program.wait(moment)
    except subprocess.TimeoutExpired:
        start = time.monotonic()
        for i, number in enumerate(signals):
            time.sleep(0.01 * (i > 0))
            program.send_signal(number)
    stderr = program.communicate(timeout=TIMEOUT)[1]
    if program.returncode == 0:  # the signal met one that was done already
        start = begin
    return Ending(program.returncode, stderr, time.monotonic() - start)


class Moments:
    """Random moments of a bake that takes `seconds`; the seed is printed, so that a failure can be reproduced."""

    def __init__(self, seconds, seed=None):
        self.seed = random.randrange(10**6) if seed is None else seed
        self.seconds, self.random = seconds, random.Random(self.seed)

    def next(self):
        return self.random.uniform(0, self.seconds)

    def learn(self, ending):
        """A bake that was faster than the signal updates the expected duration."""
        if ending.code == 0:
            self.seconds = min(self.seconds, ending.seconds)
