#!/usr/bin/env python3
"""Simulates a sweep on many Slurm nodes from the recorded durations of its flights: how long it takes on
1 to 128 nodes, and the efficiency, which is the time on one node / (nodes x time on that many).

Workers take flights as `overfly sweep work` does: in the sweep's order, the next one when the last has
been delivered. Not simulated: a file system that gets slower with the number of nodes.

Usage: sweep_scaling.py SWEEP_FOLDER... [--repeats N] [--longest-s S] [--start-s S] [--take-s S] [--interval-s S]
  --repeats N   flights of each recorded one; their durations vary as the recorded ones (default 20)
  --longest-s S leave out recorded flights that took longer: they were paused, or shared the machine (all)
  --start-s S   from the submission of an array to a task's first flight, evenly from 0 to S (20)
  --take-s S    to take a flight and to deliver it (1)
  --interval-s  at which the sweep command looks for the last flight (5)
"""

import argparse
import heapq
import json
import pathlib
import random

NODES = [1, 2, 4, 8, 16, 32, 64, 128]


def durations_s(folder: pathlib.Path) -> list[float]:
    """Of the flights of a sweep, in the order of their results; estimators share a flight."""
    flights = {}
    for line in (folder / "results.jsonl").read_text().splitlines():
        try:
            result = json.loads(line)
        except json.JSONDecodeError:
            continue  # The last line of a sweep that flies or was killed.
        if result["status"] == "completed":
            flights[result["run"]] = result["duration_s"]
    return list(flights.values())


def makespan_s(flights: list[float], nodes: int, options, chance: random.Random) -> float:
    """Until the sweep command has the last result."""
    free_at = [chance.uniform(0.0, options.start_s) for _ in range(nodes)]
    heapq.heapify(free_at)
    end = 0.0
    for duration in flights:
        delivered = heapq.heappop(free_at) + options.take_s + duration
        end = max(end, delivered)
        heapq.heappush(free_at, delivered)
    return end + options.interval_s


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--repeats", type=int, default=20)
    parser.add_argument("--longest-s", type=float, default=float("inf"))
    parser.add_argument("--start-s", type=float, default=20.0)
    parser.add_argument("--take-s", type=float, default=1.0)
    parser.add_argument("--interval-s", type=float, default=5.0)
    options = parser.parse_args()
    flown = [duration for folder in options.folders for duration in durations_s(folder)]
    recorded = [duration for duration in flown if duration <= options.longest_s]
    if not recorded:
        raise SystemExit("no completed flight in " + ", ".join(map(str, options.folders)))
    if len(recorded) < len(flown):
        print(f"left out: {len(flown) - len(recorded)} flights of more than {options.longest_s:.0f} s")
    chance = random.Random(1)
    # All cells once, then all twice, as a sweep does.
    flights = recorded + [chance.choice(recorded) for _ in range((options.repeats - 1) * len(recorded))]
    one_node_s = sum(flights)
    print(f"{len(flights)} flights from {len(recorded)} recorded ones of {min(recorded):.0f} to "
          f"{max(recorded):.0f} s; {one_node_s / 3600:.1f} h of flying")
    print("| nodes | time [min] | efficiency |\n|---|---|---|")
    for nodes in NODES:
        end = makespan_s(flights, nodes, options, chance)
        print(f"| {nodes} | {end / 60:.1f} | {100 * one_node_s / (nodes * end):.0f} % |")


if __name__ == "__main__":
    main()
