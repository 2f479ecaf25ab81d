#!/usr/bin/env python3
"""scenes/farm/submit.sh on a real Slurm: a controller and one node on the loopback interface, in a
temporary folder, for the time of the test. Skipped where Debian's slurm-wlm is not installed.
"""

import getpass
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

from harness import BIN, SOURCE, CliTest, main

DAEMONS = ("slurmctld", "slurmd")
CLIENTS = ("sbatch", "scontrol", "sinfo")
SUBMIT = SOURCE / "scenes/farm/submit.sh"
WAIT_SECONDS = 120

CONFIGURATION = """\
ClusterName=sss
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=1,sched_min_interval=100000
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def sbin(name):
    return shutil.which(name, path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin")


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Slurm:
    """A cluster of this machine, by itself."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="sss-slurm-"))
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        host = socket.gethostname().split(".")[0]
        conf = self.folder / "slurm.conf"
        conf.write_text(CONFIGURATION.format(host=host, user=getpass.getuser(), folder=self.folder,
                                             ports=free_ports(2)))
        self.environment = {**os.environ, "SLURM_CONF": str(conf), "SSS_BIN": str(BIN)}
        self.logs = [(self.folder / f"{name}.log").open("wb") for name in DAEMONS]
        self.processes = [subprocess.Popen([sbin(name), "-D", "-f", str(conf)], stdout=log,
                                           stderr=subprocess.STDOUT, env=self.environment)
                          for name, log in zip(DAEMONS, self.logs)]
        wait_for(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T", check=False), self.words)

    def words(self):
        return "\n".join((self.folder / f"{name}.log").read_text() for name in DAEMONS)

    def ask(self, *command, check=True):
        done = subprocess.run(list(map(str, command)), env=self.environment, capture_output=True,
                              check=False)
        if check and done.returncode != 0:
            raise AssertionError(f"{command}: {done.stderr.decode()}\n{self.words()}")
        return done.stdout.decode()

    def tasks(self, job):
        """{frame: (state, exit code)} of an array; those that are not apart yet are left out."""
        text = self.ask("scontrol", "show", "job", "-o", job)
        tasks = {}
        for line in text.splitlines():
            words = dict(word.split("=", 1) for word in line.split() if "=" in word)
            if words.get("ArrayTaskId", "").isdigit():
                tasks[int(words["ArrayTaskId"])] = (words["JobState"], words["ExitCode"])
        return tasks

    def stop(self):
        for process in reversed(self.processes):
            process.send_signal(signal.SIGTERM)
            process.wait(timeout=WAIT_SECONDS)
        for log in self.logs:
            log.close()
        shutil.rmtree(self.folder, ignore_errors=True)


def wait_for(is_so, words):
    until = time.monotonic() + WAIT_SECONDS
    while not is_so():
        if time.monotonic() > until:
            raise AssertionError(f"waited {WAIT_SECONDS} s in vain\n{words()}")
        time.sleep(0.2)


MISSING = [name for name in DAEMONS + CLIENTS if not sbin(name)]


@unittest.skipIf(MISSING, f"no {', '.join(MISSING)} here: install slurm-wlm")
class Farm(CliTest):
    @classmethod
    def setUpClass(cls):
        cls.slurm = Slurm()
        cls.addClassCleanup(cls.slurm.stop)

    def submit(self, scene, frames, **environment):
        """The numbers of the jobs of both passes."""
        done = subprocess.run([str(SUBMIT), scene, frames, "out"], cwd=self.folder, check=False,
                              env={**self.slurm.environment, **environment}, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return re.search(r"pass 1 is job (\d+), pass 2 job (\d+)", done.stdout.decode()).groups()

    def words(self):
        logs = sorted((self.folder / "out/log").glob("*.txt"))
        return "\n".join([self.slurm.words(), *(f"{p.name}: {p.read_text()}" for p in logs)])

    def wait_for(self, job, frames, states):
        wait_for(lambda: [self.slurm.tasks(job).get(n, ("",))[0] in states for n in frames]
                 == [True] * len(frames), self.words)
        return self.slurm.tasks(job)

    ENDED = ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT")

    def test_frames(self):
        scene = self.write_scene(lights=[{"type": "point", "intensity": 9, "position": {
            "keys": [{"frame": 1, "value": [-20, 20, 10]}, {"frame": 3, "value": [20, 20, 10]}]}}])
        pass1, pass2 = self.submit(scene, "1-3")
        done = ("COMPLETED", "0:0")
        self.assertEqual(self.wait_for(pass2, (1, 2, 3), self.ENDED), {1: done, 2: done, 3: done})
        self.assertEqual(self.slurm.tasks(pass1), {1: done, 2: done, 3: done})
        self.assert_ok(self.render(scene, "--frames", "1-3", "-o", "here.####.exr"))
        for n in range(1, 4):
            for kind in ("exr", "png"):
                self.assertEqual((self.folder / f"out/{n:04d}.{kind}").read_bytes(),
                                 (self.folder / f"here.{n:04d}.{kind}").read_bytes(), self.words())
        # The same again finds everything done.
        _, pass2 = self.submit(scene, "1-3")
        self.assertEqual(self.wait_for(pass2, (1, 2, 3), self.ENDED), {1: done, 2: done, 3: done})
        self.assertIn("is complete", (self.folder / "out/log/pass2-2.txt").read_text())

    def test_failed_pass_1(self):
        """Pass 2 does not wait for ever."""
        scene = self.write_mesh_scene("none.obj")
        pass1, pass2 = self.submit(scene, "1")
        self.assertEqual(self.wait_for(pass1, (1,), self.ENDED), {1: ("FAILED", "4:0")})
        wait_for(lambda: "JobState=CANCELLED" in self.slurm.ask("scontrol", "show", "job", pass2),
                 self.words)
        self.assertEqual(list((self.folder / "out").glob("*.exr")), [])

    def test_time_that_is_up(self):
        """The program is told before Slurm's minute is over, and leaves nothing that is not whole."""
        scene = self.write_scene(film={"width": 4000, "height": 3000, "samples": 4096})
        _, pass2 = self.submit(scene, "1", SBATCH_TIMELIMIT="1")
        self.assertEqual(self.wait_for(pass2, (1,), self.ENDED), {1: ("FAILED", "143:0")})
        self.assertIn("ERROR interrupted", (self.folder / "out/log/pass2-1.txt").read_text())
        self.assertEqual(list((self.folder / "out").rglob("*.tmp-*")), [])
        self.assertEqual(list((self.folder / "out").glob("*.exr")), [])


if __name__ == "__main__":
    main()
