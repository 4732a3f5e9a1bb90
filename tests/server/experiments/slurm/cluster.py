"""A Slurm cluster of this one machine, on the loopback address, in a temporary folder.

Needs slurmctld, slurmd, munged and root. Starts and ends only its own processes.
"""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

SKIPPED = 77


def missing() -> str:
    """Why no cluster can be started here; empty if one can."""
    for program in ("slurmctld", "slurmd", "munged", "sbatch", "squeue", "scancel", "scontrol"):
        if not shutil.which(program, path=f"{os.environ['PATH']}:/usr/sbin"):
            return f"{program} is not installed"
    if os.geteuid() != 0:
        return "slurmd needs root"
    try:
        socket.getaddrinfo(socket.gethostname(), None)
    except OSError:
        return f"the host name {socket.gethostname()} has no address"
    return ""


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Cluster:
    """One node, a partition `low` and a partition `high` that preempts it."""

    def __init__(self, folder: pathlib.Path, processors: int = 2):
        """`processors`: how many Slurm believes the node to have, one for each task."""
        self.folder = folder
        self.node = socket.gethostname()
        self.processes: dict[str, subprocess.Popen] = {}
        for name in ("state", "spool", "log"):
            (folder / name).mkdir(parents=True)
        key = folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        memory_mib = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20 - 512
        self.conf = folder / "slurm.conf"
        self.conf.write_text(f"""
ClusterName=overflytest
SlurmctldHost={self.node}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/log/slurmctld.txt
SlurmdLogFile={folder}/log/slurmd.txt
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
SchedulerParameters=bf_interval=1,sched_interval=2,requeue_setup_env_fail
ReturnToService=2
SlurmdTimeout=10
SlurmdParameters=config_overrides
KillWait=3
MinJobAge=5
InactiveLimit=0
MaxArraySize=1001
MaxJobCount=5000
NodeName={self.node} NodeAddr=127.0.0.1 CPUs={processors} CoresPerSocket={processors} ThreadsPerCore=1 RealMemory={memory_mib}
PartitionName=low Nodes={self.node} Default=YES PriorityTier=1 PreemptMode=REQUEUE OverSubscribe=NO
PartitionName=high Nodes={self.node} PriorityTier=10 PreemptMode=OFF OverSubscribe=NO
""")
        os.environ["SLURM_CONF"] = str(self.conf)

    def launch(self, name: str, *words: str) -> None:
        with open(self.folder / "log" / f"{name}.out", "ab") as log:
            self.processes[name] = subprocess.Popen(
                words, stdout=log, stderr=log, start_new_session=True,
                env=os.environ | {"PATH": f"{os.environ['PATH']}:/usr/sbin"})

    def start(self) -> None:
        self.launch("munged", "/usr/sbin/munged", "--foreground", "--force",
                    f"--key-file={self.folder}/munge.key", f"--socket={self.folder}/munge.socket",
                    f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/log/munged.txt",
                    f"--seed-file={self.folder}/munge.seed")
        self.wait_for("munged", lambda: (self.folder / "munge.socket").exists())
        self.start_controller()
        self.start_node()
        self.wait_for("an idle node", lambda: "idle" in self.node_state())

    def start_node(self) -> None:
        self.launch("slurmd", "/usr/sbin/slurmd", "-D", "-f", str(self.conf), "-N", self.node)

    def kill_node(self) -> None:
        """Its daemon, not what it has started."""
        self.processes["slurmd"].kill()
        self.processes.pop("slurmd").wait()

    def node_state(self) -> str:
        return self.text("sinfo", "-h", "-o", "%T")

    def start_controller(self) -> None:
        self.launch("slurmctld", "/usr/sbin/slurmctld", "-D", "-f", str(self.conf))

    def kill_controller(self) -> None:
        self.processes["slurmctld"].kill()
        self.processes.pop("slurmctld").wait()

    def stop(self) -> None:
        self.text("scancel", "--user=root")
        time.sleep(1)
        for name in ("slurmd", "slurmctld", "munged"):
            process = self.processes.get(name)
            if process is None or process.poll() is not None:
                continue
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    @staticmethod
    def text(*words: str) -> str:
        """What a command prints; empty if it fails."""
        result = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
        return result.stdout if result.returncode == 0 else ""

    def running_tasks(self) -> list[str]:
        """Ids of tasks that run now: ["17_0", ...]."""
        return self.text("squeue", "-h", "--array", "--states=running", "-o", "%i").split()

    def wait_for(self, what: str, condition, timeout_s: float = 60.0) -> None:
        # Counted in rounds: the clock of a virtual machine that was paused jumps, and then nobody
        # would have had the time.
        rounds_left = int(timeout_s / 0.2)
        while not condition():
            ended = [name for name, process in self.processes.items() if process.poll() is not None]
            if ended or rounds_left == 0:
                logs = "\n".join(f"--- {file.name}\n{file.read_text(errors='replace')[-3000:]}"
                                 for file in sorted((self.folder / "log").iterdir()))
                reason = f"{', '.join(ended)} ended" if ended else f"not within {timeout_s:.0f} s"
                raise RuntimeError(f"no {what}: {reason}\n{logs}")
            rounds_left -= 1
            time.sleep(0.2)
