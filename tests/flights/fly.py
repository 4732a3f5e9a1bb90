#!/usr/bin/env python3
"""Flies one scenario through the real program and judges its metrics.

Usage: fly.py BINARY RESULTS_FOLDER NAME SCENARIO [--needs FILE] [--set path=value]...
              [--outcome COMPLETED] [--max-init-scale-rmse-m M] [--max-sim3-rmse-m M]
              [--max-rotation-deg D] [--max-start-s S]

Exit code 0 = within the limits, 1 = not, 77 = skipped (the data it needs is absent). The result
stands in RESULTS_FOLDER/NAME.json for summary.py.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import time

SKIPPED = 77


def aligned(alignment, field):
    return lambda estimator: estimator["alignments"].get(alignment, {}).get(field)


LIMITS = {
    "init-scale-rmse-m": aligned("init_scale", "position_rmse_m"),
    "sim3-rmse-m": aligned("sim3", "position_rmse_m"),
    "rotation-deg": aligned("init_scale", "rotation_rmse_deg"),
    "start-s": lambda estimator: estimator.get("initialised_at_s"),
}


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("name")
    parser.add_argument("scenario", type=pathlib.Path)
    parser.add_argument("--needs", type=pathlib.Path)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--outcome")
    for limit in LIMITS:
        parser.add_argument(f"--max-{limit}", type=float)
    return parser.parse_args()


def fly(args, folder):
    command = [args.binary, "run", args.scenario, "--out", folder]
    for override in args.set:
        command += ["--set", override]
    start = time.monotonic()
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(done.stdout[-4000:])
    if done.returncode != 0:
        sys.exit(f"{args.name}: the program ended with {done.returncode}")
    return time.monotonic() - start


def judge(args, estimator):
    faults = []
    if args.outcome and estimator["outcome"] != args.outcome:
        faults.append(f"outcome {estimator['outcome']}, must be {args.outcome}")
    for name, value_of in LIMITS.items():
        limit = getattr(args, "max_" + name.replace("-", "_"))
        value = value_of(estimator)
        if limit is not None and (value is None or not value <= limit):
            faults.append(f"{name} {value}, limit {limit}")
    return faults


def main():
    args = arguments()
    if args.needs and not args.needs.exists():
        print(f"SKIPPED {args.name}: {args.needs} is absent")
        sys.exit(SKIPPED)
    args.results.mkdir(parents=True, exist_ok=True)
    folder = args.results / args.name
    shutil.rmtree(folder, ignore_errors=True)
    wall_s = fly(args, folder)
    metrics = json.loads((folder / "metrics.json").read_text())
    estimator = next(iter(metrics["estimators"].values()))
    frames = metrics["camera"]["frames"]
    result = {"name": args.name, "wall_s": wall_s, "frames": frames, "estimator": estimator}
    (args.results / f"{args.name}.json").write_text(json.dumps(result))
    faults = judge(args, estimator)
    print("\n".join(faults) or f"{args.name}: within its limits")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
