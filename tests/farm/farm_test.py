#!/usr/bin/env python3
"""`make test-farm`: one plan, three engines, the same bytes as one bake.

The generated atrium, cut into 16 shards, is baked
  by Slurm on four nodes, in two arrays of shards (MaxArraySize is 11), one node dying with its job in the middle;
  by `svdag run -j 2`, which is ended in the middle and restarted;
  by the reference runner of Open Job Description (PyPI openjd-cli).
Where SVDAG_SCENES is set, Crytek Sponza as well, on Slurm. --only ENGINE runs a part.
"""
import argparse
import functools
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import urllib.request

from slurm import Cluster

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = ROOT / "build" / "farm"
SHARDS = 16
TIMEOUT = 170


def say(text):
    print(text, flush=True)


def hash_of(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


class Failure(Exception):
    pass


class Skipped(Exception):
    pass


def require(condition, sentence):
    if not condition:
        raise Failure(sentence)


class Farm:
    def __init__(self, programs):
        self.programs = programs
        self.svdag = str(programs / "svdag")
        self.baked = {}  # scene -> hash of one bake

    def call(self, *arguments, **options):
        done = subprocess.run([self.svdag, *map(str, arguments)], capture_output=True, text=True, timeout=TIMEOUT,
                              stdin=subprocess.DEVNULL, **options)
        require(done.returncode == 0, f"svdag {' '.join(map(str, arguments))}: exit code {done.returncode}\n"
                + done.stdout + done.stderr)
        return done.stdout

    def scene(self, name):
        if name == "sponza":
            return pathlib.Path(os.environ["SVDAG_SCENES"]) / "crytek_sponza.glb"
        path = FOLDER / f"{name}.ply"
        if not path.exists():
            subprocess.run([self.programs / "svdag-scene", name, "-q", "-o", path], check=True)
        return path

    def one_bake(self, name, resolution):
        if (name, resolution) not in self.baked:
            output = FOLDER / f"{name}.svdag"
            self.call("build", self.scene(name), "-o", output, "-r", resolution, "-q")
            self.baked[name, resolution] = hash_of(output)
            output.unlink()
        return self.baked[name, resolution]

    def plan(self, name, resolution):
        folder = FOLDER / f"{name}.plan"
        shutil.rmtree(folder, ignore_errors=True)
        self.call("plan", self.scene(name), "-r", resolution, "--shards", SHARDS, "-o", folder, "-q")
        return folder

    def steps(self, plan):
        return [step["name"] for step in json.loads((plan / "plan.json").read_text())["steps"]]

    def done(self, plan):
        return [name for name in self.steps(plan) if (plan / "runs" / f"{name}.json").exists()]

    def judge(self, name, resolution, plan):
        """The file is the one bake's, and no step took more memory than was planned."""
        output = plan / json.loads((plan / "plan.json").read_text())["steps"][-1]["output"]
        require(hash_of(output) == self.one_bake(name, resolution), f"{output} is not what one bake gives")
        for step in json.loads((plan / "plan.json").read_text())["steps"]:
            receipt = json.loads((plan / "runs" / f"{step['name']}.json").read_text())
            require(receipt["memory_bytes"] <= step["predicted"]["memory_bytes"],
                    f"{step['name']} took {receipt['memory_bytes']} bytes of memory, more than was planned")
        shutil.rmtree(plan)


def by_slurm(farm, name, resolution, with_accident):
    plan = farm.plan(name, resolution)
    cluster = Cluster(FOLDER / "slurm")
    killed = None
    try:
        cluster.start()
        log = open(FOLDER / "submit.log", "w+")
        submit = subprocess.Popen([farm.svdag, "submit", plan, "--engine", "slurm", "--wait", "--", "--partition=all"],
                                  env=cluster.environment(), stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        deadline = time.monotonic() + TIMEOUT
        while submit.poll() is None and time.monotonic() < deadline:
            if with_accident and killed is None and len(farm.done(plan)) >= 2:
                running = cluster.running()
                if running:
                    job, node = running[-1]
                    if cluster.kill_node(node, job):
                        killed = (job, node)
                        say(f"  node {node} was killed while it ran job {job}; "
                            f"{len(farm.done(plan))} of {len(farm.steps(plan))} steps were done")
            time.sleep(0.02)
        log.seek(0)
        if submit.poll() is None:
            submit.terminate()
            submit.wait()
            raise Failure("the plan was not done in time\n" + log.read() + cluster.ask("squeue") + cluster.ask("sinfo"))
        said = log.read()
        require(submit.returncode == 0, f"submit --wait: exit code {submit.returncode}\n" + said)
        arrays = [line.split(":")[0] for line in said.splitlines() if line.startswith("shards-")]
        require(arrays == ["shards-1", "shards-10"], f"{SHARDS} shards went in the arrays {arrays}:\n{said}")
        logs = sorted(path.name for path in (plan / "logs").glob("shard-*.slurm.log"))
        require(len(logs) == SHARDS and "shard-10.slurm.log" in logs, f"not a log per shard: {logs}")
        if with_accident:
            require(killed, "every job was too fast to be killed while it ran")
            job = cluster.ask("scontrol", "show", "job", killed[0])
            require("Restarts=1" in job, f"the killed job was not run again:\n{job}")
        again = farm.call("submit", plan, "--engine", "slurm", env=cluster.environment())
        require("every step of the plan is done" in again, "a plan that is done was submitted again:\n" + again)
    finally:
        cluster.stop()
    farm.judge(name, resolution, plan)


def interrupted(farm, plan):
    """The exit code of a run that is interrupted in its middle; 0 if it was at its end by then."""
    # What is started in the background, as by nohup, ignores interrupts, and so would its children.
    obey = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    run = subprocess.Popen([farm.svdag, "run", plan, "-j", "2", "-q"], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE,
                           preexec_fn=obey)
    receipts = [plan / "runs" / f"{name}.json" for name in farm.steps(plan)]
    while sum(map(pathlib.Path.exists, receipts)) < 3 and run.poll() is None:
        time.sleep(0.002)
    run.send_signal(signal.SIGINT)
    run.communicate(timeout=30)
    return run.returncode


def by_run(farm, name, resolution):
    for _ in range(5):  # a machine that is busy elsewhere may let the run end first
        plan = farm.plan(name, resolution)
        code = interrupted(farm, plan)
        if code != 0:
            break
        require(len(farm.done(plan)) == len(farm.steps(plan)), "svdag run, interrupted: exit code 0, and steps are missing")
    require(code == 130, f"svdag run, interrupted: exit code {code}")
    done = len(farm.done(plan))
    require(done < SHARDS, "svdag run went on after the interrupt")
    (plan / "runs" / "shard-1.run").write_bytes(b"not a run")
    farm.call("run", plan, "-j", "2")
    say(f"  ended after {done} steps, one of them damaged, and restarted")
    farm.judge(name, resolution, plan)


def openjd():
    """The program `openjd`, installed where that is possible; None where PyPI cannot be reached."""
    venv = FOLDER / "openjd"
    program = venv / "bin" / "openjd"
    if not program.exists():
        subprocess.run([sys.executable, "-m", "venv", venv], check=True)
        installed = subprocess.run([venv / "bin" / "pip", "install", "-q", "--disable-pip-version-check", "openjd-cli"],
                                   capture_output=True, text=True)
        if installed.returncode != 0:
            try:
                urllib.request.urlopen("https://pypi.org/simple/openjd-cli/", timeout=10).close()
            except OSError:
                return None
            raise Failure("openjd-cli could not be installed, though PyPI answers:\n" + installed.stderr)
    return program


def by_openjd(farm, name, resolution):
    program = openjd()
    if program is None:
        raise Skipped("PyPI cannot be reached, so openjd-cli could not be installed")
    plan = farm.plan(name, resolution)
    template = farm.call("submit", plan, "--engine", "openjd").strip()
    for command in (["check", template], ["run", template]):
        done = subprocess.run([program, *command], capture_output=True, text=True, timeout=TIMEOUT)
        require(done.returncode == 0, f"openjd {command[0]}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    farm.judge(name, resolution, plan)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", required=True, type=pathlib.Path)
    parser.add_argument("--only", choices=["slurm", "run", "openjd", "sponza"])
    options = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    farm = Farm(options.programs.resolve())
    tests = {"slurm": ("Slurm, a node dies", lambda: by_slurm(farm, "atrium", "16K", True)),
             "run": ("svdag run, ended and restarted", lambda: by_run(farm, "atrium", "4K")),
             "openjd": ("Open Job Description", lambda: by_openjd(farm, "atrium", "4K"))}
    if os.environ.get("SVDAG_SCENES") and farm.scene("sponza").exists():
        tests["sponza"] = ("Slurm, Crytek Sponza", lambda: by_slurm(farm, "sponza", "4K", False))
    elif options.only == "sponza":
        sys.exit("SVDAG_SCENES does not lead to Crytek Sponza")
    if os.geteuid() != 0 and options.only in (None, "slurm", "sponza"):
        sys.exit("test-farm starts the daemons of Slurm: run it as root, or with --only run or openjd")
    failed = 0
    for key, (title, test) in tests.items():
        if options.only not in (None, key):
            continue
        begin = time.monotonic()
        try:
            test()
            say(f"ok      {title}: the same bytes ({time.monotonic() - begin:.0f} s)")
        except Skipped as reason:
            say(f"skipped {title}: {reason}")
        except (Failure, subprocess.TimeoutExpired, RuntimeError) as failure:
            failed += 1
            say(f"FAILED  {title}: {failure}")
    return failed > 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that `finally` ends the daemons
    sys.exit(main())
