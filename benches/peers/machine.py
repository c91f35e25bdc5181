"""The machine that a comparison runs on, and its messages."""

import datetime
import os
import platform
import sys

# A comparison is about so many cores, wherever it runs.
CORES = 2


def keep_to_cores():
    """Keeps this process and its children to the first cores; how many there are."""
    cores = sorted(os.sched_getaffinity(0))[:CORES]
    os.sched_setaffinity(0, cores)
    return len(cores)


def processor():
    """The processor's name as Linux tells it."""
    with open("/proc/cpuinfo", encoding="utf-8") as lines:
        names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def system():
    """The operating system's name."""
    return platform.freedesktop_os_release()["PRETTY_NAME"]


def tell(text):
    """Progress, on stderr."""
    print(f"{datetime.datetime.now():%H:%M:%S} {text}", file=sys.stderr, flush=True)
