"""Runs bakes and sends them signals at random moments."""
import random
import subprocess
import time
from typing import NamedTuple

TIMEOUT = 120


class Ending(NamedTuple):
    code: int  # exit status, or minus the number of the signal that killed it
    stderr: str
    seconds: float  # from the first signal to the end; of the whole bake if it ended before


def time_of(command, cwd):
    start = time.monotonic()
    subprocess.run(command, cwd=cwd, check=True)
    return time.monotonic() - start


def hit(command, cwd, moment, signals):
    """Runs the bake and sends it `signals` after `moment` seconds, 0.01 s apart."""
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
    if program.returncode == 0:  # the bake had finished before the signal
        start = begin
    return Ending(program.returncode, stderr, time.monotonic() - start)


class Moments:
    """Random moments within the duration of a bake; tests print the seed to reproduce a failure."""

    def __init__(self, seconds, seed=None):
        self.seed = random.randrange(10**6) if seed is None else seed
        self.seconds, self.random = seconds, random.Random(self.seed)

    def next(self):
        return self.random.uniform(0, self.seconds)

    def learn(self, ending):
        """Shortens the expected duration if the bake finished before the signal."""
        if ending.code == 0:
            self.seconds = min(self.seconds, ending.seconds)
