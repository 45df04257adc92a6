"""Programs on a terminal of a given width, as the other end of it sees them."""
import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time


class Screen:
    """A program whose standard streams are a terminal, except stdout if it is redirected."""

    def __init__(self, command, columns, environment=None, folder=None, results=None):
        master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
        base = {k: v for k, v in os.environ.items() if k not in ("COLUMNS", "LINES", "NO_COLOR")}
        self.master = master
        self.program = subprocess.Popen(command, cwd=folder, stdin=slave, stdout=results or slave, stderr=slave,
                                        env=base | {"TERM": "xterm", "LC_ALL": "C.UTF-8"} | (environment or {}),
                                        start_new_session=True)
        os.close(slave)
        self.seen = b""

    def read(self, timeout):
        """The output within `timeout` seconds; b"" if there is none or the program has ended."""
        if not select.select([self.master], [], [], timeout)[0]:
            return b""
        try:
            data = os.read(self.master, 1 << 16)
        except OSError:  # the terminal is closed
            return b""
        self.seen += data
        return data

    def wait_for(self, text, seconds=20):
        """Whether `text` appears from now on."""
        start, end = len(self.seen), time.monotonic() + seconds
        while text not in re.sub(rb"\x1b\[[\d;?]*[A-Za-z]", b"", self.seen[start:]):  # without escape sequences
            if time.monotonic() > end:
                return False
            self.read(0.2)
        return True

    def write(self, text):
        os.write(self.master, text.encode())

    def close(self):
        self.program.kill()
        self.program.wait()
        os.close(self.master)


def shown(command, columns, environment=None, folder=None, results=None):
    """(exit code, complete output) of a program."""
    screen = Screen(command, columns, environment, folder, results)
    while screen.program.poll() is None:
        screen.read(0.1)
    while screen.read(0.1):
        pass
    code = screen.program.returncode
    screen.close()
    return code, screen.seen.replace(b"\r\n", b"\n").decode()
