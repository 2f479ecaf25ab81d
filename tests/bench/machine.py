"""Says on what was measured."""

import os
import platform
import subprocess

import programs


def describe():
    return {
        "commit": commit(),
        "processor": processor(),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "system": platform.platform(),
        **programs.bench("machine"),
    }


def commit():
    done = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=programs.SOURCE,
                          capture_output=True, text=True)
    return done.stdout.strip() or "not a git checkout"


def processor():
    with open("/proc/cpuinfo") as file:
        for line in file:
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.machine()
