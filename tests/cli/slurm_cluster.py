# SPDX-License-Identifier: Apache-2.0
"""A real Slurm on this machine: one slurmctld and two slurmd of one core each, all under one folder. Each node has a mount
namespace with a disk of its own at `local`, by which its processes are told, too: killing them all is a node without power."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ("slurmctld", "slurmd", "sbatch", "munged")


def lacking():
    """Why there can be no cluster here, or nothing."""
    missing = [name for name in PROGRAMS if shutil.which(name, path="/usr/sbin:/usr/bin:" + os.environ["PATH"]) is None]
    if missing:
        return f"no {', '.join(missing)} here (slurm-wlm, munge)"
    return "" if os.geteuid() == 0 else "slurmd needs root"


CONFIG = """
ClusterName=t
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/ctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/log/ctld.log
SlurmdLogFile={folder}/log/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SlurmdTimeout=10
KillWait=10
SchedulerParameters=batch_sched_delay=0,sched_interval=2,bf_interval=2
AccountingStorageType=accounting_storage/none
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={port1} CPUs=1 Weight=1
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={port2} CPUs=1 Weight=2
PartitionName=p Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def wait_for(what, seconds, why):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if what():
            return
        time.sleep(0.2)
    raise AssertionError(f"not within {seconds} s: {why() if callable(why) else why}")


class Cluster:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.local = self.folder / "local"
        for name in ("state", "spool", "log", "munge", "local"):
            (self.folder / name).mkdir(parents=True)
        port, port1, port2 = free_ports(3)
        self.config = self.folder / "slurm.conf"
        host = socket.gethostname().split(".")[0]
        self.config.write_text(CONFIG.format(host=host, folder=self.folder, port=port, port1=port1, port2=port2))
        self.environment = {**os.environ, "SLURM_CONF": str(self.config), "TMPDIR": str(self.local),
                            "PATH": "/usr/sbin:/usr/bin:/sbin:/bin:" + os.environ["PATH"]}
        # One thread a node: PoCL counts the machine's cores.
        self.environment.update(POCL_MAX_PTHREAD_COUNT="1", POCL_CPU_MAX_CU_COUNT="1")
        self.daemons = []
        self.nodes = {}
        # It runs as its own user, who must come to its files through this folder.
        self.folder.chmod(0o755)
        key = self.folder / "munge/key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        for path in (key, key.parent):
            shutil.chown(path, "munge", "munge")
        key.parent.chmod(0o755)
        self.daemon("runuser", "-u", "munge", "--", "munged", "--foreground", f"--key-file={key}",
                    f"--socket={key.parent}/socket", f"--pid-file={key.parent}/pid", f"--log-file={key.parent}/log",
                    f"--seed-file={key.parent}/seed")
        wait_for((key.parent / "socket").exists, 20, "munged is up")
        self.daemon("slurmctld", "-D", "-f", self.config)
        self.start_node("n1")
        self.start_node("n2")
        self.wait_until_idle()

    def daemon(self, *words):
        with open(self.folder / "log/daemons", "ab") as log:
            self.daemons.append(subprocess.Popen([str(word) for word in words], env=self.environment, stdout=log, stderr=log,
                                                 stdin=subprocess.DEVNULL, start_new_session=True))
        return self.daemons[-1]

    def start_node(self, name, disk="64m"):
        core = sorted(os.sched_getaffinity(0))[int(name[1:]) % len(os.sched_getaffinity(0))]
        self.nodes[name] = self.daemon(
            "unshare", "-m", "bash", "-c", 'mount -t tmpfs -o "size=$1" tmpfs "$2" && exec taskset -c "$3" slurmd -D -N "$4" -f "$5"',
            "bash", disk, self.local, core, name, self.config)

    def kill_node(self, name):
        """All processes of its mount namespace, at once."""
        space = os.readlink(f"/proc/{self.nodes[name].pid}/ns/mnt")
        assert space != os.readlink("/proc/self/ns/mnt")
        for _ in range(3):
            for process in pathlib.Path("/proc").iterdir():
                if not process.name.isdigit():
                    continue
                try:
                    if os.readlink(process / "ns/mnt") == space:
                        os.kill(int(process.name), signal.SIGKILL)
                except OSError:
                    pass
        self.nodes.pop(name).wait()

    def restart_node(self, name, disk="64m"):
        if name in self.nodes:
            self.kill_node(name)
        self.start_node(name, disk)
        self.wait_until_idle()

    def wait_until_idle(self):
        wait_for(lambda: self.ask("sinfo", "-h", "-N", "-o", "%T").split() == ["idle"] * 2, 120,
                 lambda: self.ask("sinfo", "-N", "-l"))

    def ask(self, *words):
        run = subprocess.run([str(word) for word in words], env=self.environment, capture_output=True, text=True, check=False)
        return run.stdout + run.stderr

    def jobs(self):
        """State and node of each job and array task by its id, \"17_2\"."""
        lines = self.ask("squeue", "-h", "-r", "-o", "%i %T %N").splitlines()
        return {line.split()[0]: line.split()[1:] for line in lines}

    def stop(self):
        for name in list(self.nodes):
            self.kill_node(name)
        for process in reversed(self.daemons):
            if process.poll() is None:
                process.terminate()
                try:
                    process.wait(20)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
