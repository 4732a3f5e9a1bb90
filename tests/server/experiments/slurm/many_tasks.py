#!/usr/bin/env python3
"""Flies a sweep of 1000 short flights through a real Slurm as one array of 1000 tasks, of which some
are cancelled, requeued and killed all the time; then compares every flight with the same sweep flown
without Slurm. Takes about half an hour on two processors, and is therefore no part of the tests.

Usage: many_tasks.py OVERFLY [--flights N] [--at-once N] [--without-local]
"""

import argparse
import contextlib
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

import cluster
import slurm_test


def disturb(slurm: cluster.Cluster, sweep: slurm_test.Sweep, chance: random.Random,
            done: dict[str, int]) -> None:
    """Takes a running task away, in one of three ways."""
    running = slurm.running_tasks()
    flying = sweep.workers()
    if not running or not flying:
        return
    what = chance.choice(["cancelled", "requeued", "killed"])
    task = chance.choice(running)
    if what == "cancelled":
        slurm.text("scancel", task)
    elif what == "requeued":
        subprocess.run(["scontrol", "requeue", task], check=False, stderr=subprocess.DEVNULL)
    else:
        with contextlib.suppress(ProcessLookupError):  # Over in between.
            os.kill(chance.choice(flying), signal.SIGKILL)
    done[what] = done.get(what, 0) + 1


def fly(overfly: str, folder: pathlib.Path, slurm: cluster.Cluster, options) -> None:
    speeds = [round(10 + 0.02 * i, 2) for i in range(options.flights)]
    file = slurm_test.sweep_file(folder, speeds, 2)
    sweep = slurm_test.Sweep(overfly, file, folder / "by_slurm", jobs=options.flights)
    start = time.monotonic()
    chance, done = random.Random(1), {}
    most_tasks = printed = 0
    try:
        while sweep.process.poll() is None:
            time.sleep(8)
            queued = len(slurm.text("squeue", "-h", "--array", "-o", "%i").split())
            most_tasks = max(most_tasks, queued)
            if sweep.delivered() >= printed + 50:
                printed = sweep.delivered()
                print(f"{time.monotonic() - start:5.0f} s: {printed} flights, {queued} tasks, "
                      f"taken away: {done}", flush=True)
            disturb(slurm, sweep, chance, done)
        if sweep.process.returncode != 0:
            raise RuntimeError(sweep.log.read_text()[-4000:])
    finally:
        sweep.kill()
    by_slurm = slurm_test.flights(sweep.out)
    assert len(by_slurm) == options.flights, len(by_slurm)
    print(f"{len(by_slurm)} flights, each with one result of its own cell, in "
          f"{time.monotonic() - start:.0f} s; at most {most_tasks} tasks; taken away: {done}")
    if not options.without_local:
        slurm_test.compare_with_local(overfly, file, folder, sweep, slurm)


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("overfly")
    parser.add_argument("--flights", type=int, default=1000)
    parser.add_argument("--at-once", type=int, default=4, help="processors of Slurm's node")
    parser.add_argument("--without-local", action="store_true")
    options = parser.parse_args()
    reason = cluster.missing()
    if reason:
        print(f"skipped: {reason}")
        return cluster.SKIPPED
    with tempfile.TemporaryDirectory(prefix="overfly-slurm-", ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        slurm = cluster.Cluster(folder / "cluster", processors=options.at_once)
        try:
            slurm.start()
            fly(options.overfly, folder, slurm, options)
        finally:
            slurm.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
