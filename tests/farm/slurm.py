"""A Slurm cluster of four nodes on this machine, as root, without systemd and cgroups.

All its files are in one folder. The daemons run in the foreground as child processes. Processes that they start are
identified by SLURM_CONF in their environment, so stop() ends exactly the processes of this cluster.
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
START_TIMEOUT = 60  # seconds until the nodes must be idle

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
    """The first number of `count` consecutive free ports."""
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
    """Whether a process is stopped by SIGSTOP, not ended; waits until it is one of the two."""
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
        self.short_folder = None  # of the socket, if the path of `folder` is too long for one

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
        munge_folder = self.folder / "munge"
        if len(str(munge_folder)) > 80:
            self.short_folder = munge_folder = pathlib.Path(tempfile.mkdtemp(prefix="munge-"))
            munge_folder.chmod(0o755)
        self.socket = munge_folder / "socket"
        key = self.folder / "munge" / "key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.daemon("munged", ["munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.socket}",
                               f"--pid-file={munge_folder}/pid", f"--log-file={munge_folder}/log",
                               f"--seed-file={munge_folder}/seed"])
        deadline = time.monotonic() + START_TIMEOUT
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

    def query(self, *command):
        return subprocess.run(command, env=self.environment(), capture_output=True, text=True, timeout=60).stdout

    def wait_until_idle(self):
        deadline = time.monotonic() + START_TIMEOUT
        while self.query("sinfo", "-h", "-N", "-o", "%T").split() != ["idle"] * NODES:
            dead = [name for name, daemon in self.daemons.items() if daemon.poll() is not None]
            if dead or time.monotonic() > deadline:
                raise RuntimeError(f"the nodes are not idle; ended: {dead}\n" + self.query("sinfo", "-N", "-l") +
                                   "".join(self.log(name) for name in dead or self.daemons))
            time.sleep(0.1)

    def running(self):
        """[(job, node)] of the running jobs."""
        return [line.split() for line in self.query("squeue", "-h", "-t", "R", "-o", "%A %N").splitlines()]

    def started_processes(self, test=lambda entry, environment: True):
        """The ids of the processes that the daemons started, without the daemons, that pass `test`."""
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
        """Kills the daemon and the job of a node at once, like a power cut. Returns False and kills nothing if the job
        may have ended: its slurmstepd is stopped first, then its script, and only if the script still exists then
        has the job certainly not reported its end."""
        step_daemons = self.started_processes(
            lambda entry, _: f"slurmstepd: [{job}".encode() in (entry / "cmdline").read_bytes())
        signal_all(step_daemons, signal.SIGSTOP)
        script = self.started_processes(lambda _, environment: f"SLURM_JOB_ID={job}".encode() in environment)
        script = [process for process in script if process not in step_daemons]
        signal_all(script, signal.SIGSTOP)
        if not step_daemons or not all(map(has_stopped, step_daemons)) or not any(map(has_stopped, script)):
            signal_all(step_daemons + script, signal.SIGCONT)
            return False
        self.daemons[node].kill()
        self.daemons[node].wait()
        signal_all(step_daemons + script, signal.SIGKILL)
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
        signal_all(self.started_processes(), signal.SIGKILL)
        if self.short_folder:
            shutil.rmtree(self.short_folder, ignore_errors=True)
