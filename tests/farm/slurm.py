"""A Slurm of four nodes on this machine, as root, without systemd and cgroups.

Everything it writes is in one folder. Daemons run in the foreground as our children; what they
start is known by the SLURM_CONF in its environment, so stop() ends exactly what start() began.
"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time

NODES = 4
PATIENCE = 60  # seconds until the nodes must be idle

CONF = """
ClusterName=svdag
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={socket},cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SlurmdParameters=config_overrides
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SchedulerParameters=batch_sched_delay=1,sched_interval=2,bf_interval=2
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SlurmdTimeout=5
KillWait=2
MinJobAge=600
MaxArraySize=11
NodeName=n[1-{nodes}] NodeHostname={host} NodeAddr=127.0.0.1 Port={first}-{last} CPUs=1 RealMemory=2000
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    """The first of `count` consecutive free ports."""
    for first in range(16817, 60000, count):
        try:
            for port in range(first, first + count):
                with socket.socket() as probe:
                    probe.bind(("127.0.0.1", port))
            return first
        except OSError:
            continue
    raise RuntimeError("no free ports")


def signal_all(processes, number):
    for process in processes:
        try:
            os.kill(process, number)
        except ProcessLookupError:
            pass


def has_stopped(process):
    """Whether a process stopped because of the signal, rather than ended before."""
    deadline = time.monotonic() + 5
    while time.monotonic() < deadline:
        try:
            state = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return False
        if state in "TZX":
            return state == "T"
        time.sleep(0.001)
    return False


class Cluster:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder).resolve()
        self.daemons = {}  # name -> Popen
        self.short = None  # a short folder for the socket, if ours is too long for one

    def environment(self):
        return dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))

    def start(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        for name in ["state", "munge", *(f"spool-n{i}" for i in range(1, NODES + 1))]:
            (self.folder / name).mkdir(parents=True, mode=0o755)
        self.folder.chmod(0o755)
        self.start_munge()
        first = free_ports(NODES + 1)
        (self.folder / "slurm.conf").write_text(CONF.format(
            host=socket.gethostname(), port=first, first=first + 1, last=first + NODES, nodes=NODES,
            socket=self.socket, folder=self.folder))
        self.daemon("slurmctld", ["slurmctld", "-D", "-c", "-i"])
        for i in range(1, NODES + 1):
            self.daemon(f"n{i}", ["slurmd", "-D", "-N", f"n{i}"])
        self.wait_until_idle()

    def start_munge(self):
        place = self.folder / "munge"
        if len(str(place)) > 80:
            self.short = place = pathlib.Path(tempfile.mkdtemp(prefix="munge-"))
            place.chmod(0o755)
        self.socket = place / "socket"
        key = self.folder / "munge" / "key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.daemon("munged", ["munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.socket}",
                               f"--pid-file={place}/pid", f"--log-file={place}/log", f"--seed-file={place}/seed"])
        deadline = time.monotonic() + PATIENCE
        while not self.socket.exists():
            if self.daemons["munged"].poll() is not None or time.monotonic() > deadline:
                raise RuntimeError("munged did not start: " + self.log("munged"))
            time.sleep(0.05)

    def daemon(self, name, command):
        path = f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin"
        with open(self.folder / f"{name}.out", "wb") as log:
            self.daemons[name] = subprocess.Popen(command, env=dict(self.environment(), PATH=path),
                                                  stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                                  start_new_session=True)

    def log(self, name):
        return (self.folder / f"{name}.out").read_text(errors="replace")[-2000:]

    def ask(self, *command):
        return subprocess.run(command, env=self.environment(), capture_output=True, text=True, timeout=60).stdout

    def wait_until_idle(self):
        deadline = time.monotonic() + PATIENCE
        while self.ask("sinfo", "-h", "-N", "-o", "%T").split() != ["idle"] * NODES:
            dead = [name for name, daemon in self.daemons.items() if daemon.poll() is not None]
            if dead or time.monotonic() > deadline:
                raise RuntimeError(f"the nodes are not idle; ended: {dead}\n" + self.ask("sinfo", "-N", "-l") +
                                   "".join(self.log(name) for name in dead or self.daemons))
            time.sleep(0.1)

    def running(self):
        """[(job, node)] of what runs now."""
        return [line.split() for line in self.ask("squeue", "-h", "-t", "R", "-o", "%A %N").splitlines()]

    def begun(self, test=lambda entry, environment: True):
        """Processes that the daemons started, daemons themselves left out."""
        mark = f"SLURM_CONF={self.folder / 'slurm.conf'}".encode()
        own = {daemon.pid for daemon in self.daemons.values()} | {os.getpid()}
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit() or int(entry.name) in own:
                continue
            try:
                environment = (entry / "environ").read_bytes().split(b"\0")
                if mark in environment and test(entry, environment):
                    found.append(int(entry.name))
            except OSError:  # it has ended
                continue
        return found

    def kill_node(self, node, job):
        """What a power cut does to a node: its daemon and its job end at once. False, and nothing is killed, if
        the job is not in its middle: all of it is stopped first, its overseer before its script, and only where
        the script is still there then can the job not have told anyone that it was done."""
        overseers = self.begun(lambda entry, _: f"slurmstepd: [{job}".encode() in (entry / "cmdline").read_bytes())
        signal_all(overseers, signal.SIGSTOP)
        script = self.begun(lambda _, environment: f"SLURM_JOB_ID={job}".encode() in environment)
        script = [process for process in script if process not in overseers]
        signal_all(script, signal.SIGSTOP)
        if not overseers or not all(map(has_stopped, overseers)) or not any(map(has_stopped, script)):
            signal_all(overseers + script, signal.SIGCONT)
            return False
        self.daemons[node].kill()
        self.daemons[node].wait()
        signal_all(overseers + script, signal.SIGKILL)
        return True

    def stop(self):
        for name in reversed(list(self.daemons)):
            daemon = self.daemons[name]
            daemon.terminate()
            try:
                daemon.wait(5)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        signal_all(self.begun(), signal.SIGKILL)
        if self.short:
            shutil.rmtree(self.short, ignore_errors=True)
