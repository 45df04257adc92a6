#!/usr/bin/env python3
"""`make test-farm`: tests that a plan gives the same bytes as one bake, with all three engines.

The generated atrium, divided into 16 shards, is baked
  by Slurm on four nodes, in two arrays of shards (MaxArraySize is 11); one node is killed while its job runs;
  by `svdag run -j 2`, which is interrupted and restarted;
  by the reference runner of Open Job Description (PyPI openjd-cli).
If SVDAG_SCENES is set, Crytek Sponza is baked on Slurm too, with colours. --only ENGINE runs one of the tests.
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


def log_line(text):
    print(text, flush=True)


def hash_of(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


class Failure(Exception):
    pass


class Skipped(Exception):
    pass


def require(condition, message):
    if not condition:
        raise Failure(message)


class Farm:
    def __init__(self, programs):
        self.programs = programs
        self.svdag = str(programs / "svdag")
        self.baked = {}  # (scene, options) -> hash of one bake

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

    def hash_of_one_bake(self, name, options):
        if (name, options) not in self.baked:
            output = FOLDER / f"{name}.svdag"
            self.call("build", self.scene(name), "-o", output, *options, "-q")
            self.baked[name, options] = hash_of(output)
            output.unlink()
        return self.baked[name, options]

    def plan(self, name, options):
        folder = FOLDER / f"{name}.plan"
        shutil.rmtree(folder, ignore_errors=True)
        self.call("plan", self.scene(name), *options, "--shards", SHARDS, "-o", folder, "-q")
        return folder

    def steps(self, plan):
        return [step["name"] for step in json.loads((plan / "plan.json").read_text())["steps"]]

    def done(self, plan):
        return [name for name in self.steps(plan) if (plan / "runs" / f"{name}.json").exists()]

    def judge(self, name, options, plan):
        """Requires that the output equals that of one bake, and that no step exceeded its planned memory."""
        output = plan / json.loads((plan / "plan.json").read_text())["steps"][-1]["output"]
        require(hash_of(output) == self.hash_of_one_bake(name, options),
                f"{output} differs from the output of one bake")
        for step in json.loads((plan / "plan.json").read_text())["steps"]:
            receipt = json.loads((plan / "runs" / f"{step['name']}.json").read_text())
            require(receipt["memory_bytes"] <= step["predicted"]["memory_bytes"],
                    f"{step['name']} took {receipt['memory_bytes']} bytes of memory, more than planned")
        shutil.rmtree(plan)


def by_slurm(farm, name, options, kill_a_node):
    plan = farm.plan(name, options)
    cluster = Cluster(FOLDER / "slurm")
    killed = None
    try:
        cluster.start()
        log = open(FOLDER / "submit.log", "w+")
        submit = subprocess.Popen([farm.svdag, "submit", plan, "--engine", "slurm", "--wait", "--", "--partition=all"],
                                  env=cluster.environment(), stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        deadline = time.monotonic() + TIMEOUT
        while submit.poll() is None and time.monotonic() < deadline:
            if kill_a_node and killed is None and len(farm.done(plan)) >= 2:
                running = cluster.running()
                if running:
                    job, node = running[-1]
                    if cluster.kill_node(node, job):
                        killed = (job, node)
                        log_line(f"  node {node} was killed while running job {job}; "
                            f"{len(farm.done(plan))} of {len(farm.steps(plan))} steps were done")
            time.sleep(0.02)
        log.seek(0)
        if submit.poll() is None:
            submit.terminate()
            submit.wait()
            raise Failure(f"the plan did not finish within {TIMEOUT} s\n" + log.read() + cluster.query("squeue") +
                          cluster.query("sinfo"))
        output = log.read()
        require(submit.returncode == 0, f"submit --wait: exit code {submit.returncode}\n" + output)
        arrays = [line.split(":")[0] for line in output.splitlines() if line.startswith("shards-")]
        require(arrays == ["shards-1", "shards-10"],
                f"{SHARDS} shards were submitted as the arrays {arrays}:\n{output}")
        logs = sorted(path.name for path in (plan / "logs").glob("shard-*.slurm.log"))
        require(len(logs) == SHARDS and "shard-10.slurm.log" in logs, f"expected one log per shard, found {logs}")
        if kill_a_node:
            require(killed, "every job ended before it could be killed")
            job = cluster.query("scontrol", "show", "job", killed[0])
            require("Restarts=1" in job, f"the killed job was not run again:\n{job}")
        again = farm.call("submit", plan, "--engine", "slurm", env=cluster.environment())
        require("every step of the plan is done" in again, "a finished plan was submitted again:\n" + again)
    finally:
        cluster.stop()
    farm.judge(name, options, plan)


def interrupted(farm, plan):
    """The exit code of a run that is interrupted after three steps; 0 if it had finished by then."""
    # A process in the background, as of nohup, ignores interrupts, and its children inherit that.
    restore_interrupts = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    run = subprocess.Popen([farm.svdag, "run", plan, "-j", "2", "-q"], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE,
                           preexec_fn=restore_interrupts)
    receipts = [plan / "runs" / f"{name}.json" for name in farm.steps(plan)]
    while sum(map(pathlib.Path.exists, receipts)) < 3 and run.poll() is None:
        time.sleep(0.002)
    run.send_signal(signal.SIGINT)
    run.communicate(timeout=30)
    return run.returncode


def by_run(farm, name, options):
    for _ in range(5):  # on a busy machine the run may finish before the interrupt
        plan = farm.plan(name, options)
        code = interrupted(farm, plan)
        if code != 0:
            break
        require(len(farm.done(plan)) == len(farm.steps(plan)), "svdag run, interrupted: exit code 0, but steps are missing")
    require(code == 130, f"svdag run, interrupted: exit code {code}")
    done = len(farm.done(plan))
    require(done < SHARDS, "svdag run continued after the interrupt")
    (plan / "runs" / "shard-1.run").write_bytes(b"not a run")
    farm.call("run", plan, "-j", "2")
    log_line(f"  interrupted after {done} steps, one of them then damaged, and restarted")
    farm.judge(name, options, plan)


def openjd():
    """The path of the program `openjd`, installed if it is missing; None if PyPI cannot be reached."""
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


def by_openjd(farm, name, options):
    program = openjd()
    if program is None:
        raise Skipped("PyPI cannot be reached, so openjd-cli could not be installed")
    plan = farm.plan(name, options)
    template = farm.call("submit", plan, "--engine", "openjd").strip()
    for command in (["check", template], ["run", template]):
        done = subprocess.run([program, *command], capture_output=True, text=True, timeout=TIMEOUT)
        require(done.returncode == 0, f"openjd {command[0]}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    farm.judge(name, options, plan)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", required=True, type=pathlib.Path)
    parser.add_argument("--only", choices=["slurm", "run", "openjd", "sponza"])
    options = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    farm = Farm(options.programs.resolve())
    tests = {"slurm": ("Slurm, a node is killed", lambda: by_slurm(farm, "atrium", ("-r", "16K"), True)),
             "run": ("svdag run, interrupted and restarted", lambda: by_run(farm, "atrium", ("-r", "4K"))),
             "openjd": ("Open Job Description", lambda: by_openjd(farm, "atrium", ("-r", "4K")))}
    if os.environ.get("SVDAG_SCENES") and farm.scene("sponza").exists():
        tests["sponza"] = ("Slurm, Crytek Sponza with colours", lambda: by_slurm(farm, "sponza", ("-r", "1K", "--colours"), False))
    elif options.only == "sponza":
        sys.exit("SVDAG_SCENES is not a folder with crytek_sponza.glb")
    if os.geteuid() != 0 and options.only in (None, "slurm", "sponza"):
        sys.exit("test-farm starts the daemons of Slurm: run it as root, or pass --only run or --only openjd")
    failed = 0
    for key, (title, test) in tests.items():
        if options.only not in (None, key):
            continue
        begin = time.monotonic()
        try:
            test()
            log_line(f"ok      {title}: the same bytes ({time.monotonic() - begin:.0f} s)")
        except Skipped as reason:
            log_line(f"skipped {title}: {reason}")
        except (Failure, subprocess.TimeoutExpired, RuntimeError) as failure:
            failed += 1
            log_line(f"FAILED  {title}: {failure}")
    return failed > 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that `finally` stops the daemons
    sys.exit(main())
