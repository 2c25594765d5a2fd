#!/usr/bin/env python3
"""Bakes each file of a folder as a scene, and reports every run that did not end as it should.

    tests/hostile/run.py PROGRAM FOLDER [--jobs N] [-- OPTIONS OF BAKE]

A run may succeed, or refuse the file: status 4, or 2 for an option that the file needs, with a message that names the
file. Faults are: a signal, another status, no name in the message, more than --seconds (20) or --megabytes (1000, the
largest process of the run). The exit status is 1 if there is a fault.
"""
import argparse
import concurrent.futures
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ALLOWED = (0, 2, 4)


def run(program, file, options, seconds):
    """Returns (status, seconds, megabytes, standard error). The memory is that of the largest process of the run."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "bake", str(file), "-o", f"{folder}/map", "--quiet", "--threads", "1", *options]
        start = time.monotonic()
        with open(f"{folder}/err", "wb") as err:
            child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=err, stderr=err)
            try:
                _, status, usage = wait(child, start + seconds + 20)
            except TimeoutError:
                child.kill()
                _, status, usage = os.wait4(child.pid, 0)
            child.returncode = 0  # it is waited for
        text = Path(f"{folder}/err").read_text(errors="replace")
    return os.waitstatus_to_exitcode(status), time.monotonic() - start, usage.ru_maxrss / 1000, text


def wait(child, deadline):
    while True:
        done = os.wait4(child.pid, os.WNOHANG)
        if done[0] != 0:
            return done
        if time.monotonic() > deadline:
            raise TimeoutError
        time.sleep(0.005)


def faults_of(file, status, seconds, megabytes, text, args):
    faults = []
    if status not in ALLOWED:
        faults.append(f"status {status}")
    if status != 0 and file.name not in text:
        faults.append("the message does not name the file")
    if seconds > args.seconds:
        faults.append(f"{seconds:.0f} s")
    if megabytes > args.megabytes:
        faults.append(f"{megabytes:.0f} MB")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--megabytes", type=float, default=1000)
    parser.add_argument("--verbose", action="store_true", help="print the end of each run")
    end = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    args = parser.parse_args(sys.argv[1:end])
    args.options = sys.argv[end + 1 :]  # of bake
    files = sorted(file for file in args.folder.rglob("*") if file.is_file())
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    bad = refused = 0
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        runs = pool.map(lambda file: (file, *run(args.program, file, args.options, args.seconds)), files)
        for file, status, seconds, megabytes, text in runs:
            faults = faults_of(file, status, seconds, megabytes, text, args)
            refused += status != 0
            bad += bool(faults)
            if faults or args.verbose:
                last = text.strip().replace("\n", " | ")[:300]
                what = ", ".join(faults) or f"status {status}, {seconds:.1f} s, {megabytes:.0f} MB"
                print(f"{file.relative_to(args.folder)}: {what}: {last}", flush=True)
    print(f"{len(files)} files, {refused} refused, {bad} with a fault")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
