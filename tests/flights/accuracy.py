#!/usr/bin/env python3
"""Flies the cells of the accuracy table and writes the table.

Usage: accuracy.py BINARY RESULTS_FOLDER [--worlds mcmillan,builtin] [--airspeeds 10,25]
                   [--rates 25,45,65] [--heights 50,...,400] [--seeds 101,102] [--most N]
                   [--pacing lockstep|real_time] [--drop-every N] [--label TEXT]
                   [--set path=value]... [--table docs/ACCURACY.md]

Flies one cell at a time, in a process of low priority, and writes RESULTS_FOLDER/CELL.json. Cells
that have a result are skipped, so the script can be stopped at any time and called again. --most ends
it after N flights. Two processes may share the folder if they fly different cells (--worlds, --seeds).
--table writes the table of all results in RESULTS_FOLDER; with --most 0 nothing is flown.

The images have noise of 1.5 grey levels. A seed determines this noise, the estimator's random numbers
and the built-in world. Seeds below 100 are for tuning, those above for reporting.
"""

import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = {"mcmillan": "mcmillan_course.json", "builtin": "course.json"}
NOISE = {"full_well_e": 10200, "gain_dn_per_e": 0.025, "read_noise_e": 60,
         "response": {"shape": "srgb"}}
KEPT_FROM = "## Flown again"
LIMITS = {"mcmillan": 0.25, "builtin": 0.5}  # of the Sim3 position RMSE [m]


def numbers(text):
    return [int(part) for part in text.split(",")]


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--worlds", default="mcmillan,builtin", type=lambda text: text.split(","))
    parser.add_argument("--airspeeds", default=[25, 10], type=numbers)
    parser.add_argument("--rates", default=[45, 65, 25], type=numbers)
    parser.add_argument("--heights", default=[300, 150, 400, 200, 250, 350, 100, 50], type=numbers)
    parser.add_argument("--seeds", default=[101], type=numbers)
    parser.add_argument("--most", type=int, default=1000000)
    parser.add_argument("--pacing", default="lockstep", choices=["lockstep", "real_time"])
    parser.add_argument("--drop-every", type=int, default=0, help="every n-th frame is dropped")
    parser.add_argument("--label", default="", help="distinguishes flights with other --set")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--table", type=pathlib.Path)
    return parser.parse_args()


def cells(args):
    """The outermost loop is over seeds, so that an interrupted table has every cell before any twice."""
    for seed in args.seeds:
        for airspeed in args.airspeeds:
            for rate in args.rates:
                for height in args.heights:
                    for world in args.worlds:
                        yield {"world": world, "airspeed_m_s": airspeed, "rate_deg_s": rate,
                               "height_m": height, "seed": seed}


def mode_of(args):
    mode = args.pacing
    if args.drop_every:
        mode += f" 1-in-{args.drop_every}-dropped"
    return f"{mode} {args.label}".strip()


def name_of(cell, mode):
    tail = mode.replace(" ", "_").replace("/", "_")
    return (f"{cell['world']}_{cell['airspeed_m_s']}ms_{cell['rate_deg_s']}dps_"
            f"{cell['height_m']}m_seed{cell['seed']}_{tail}")


def command_of(args, cell, folder):
    course = "flight.course."
    sets = [f"seed={cell['seed']}", f"pacing={args.pacing}", f"camera.sensor={json.dumps(NOISE)}",
            f"{course}airspeed_m_s={cell['airspeed_m_s']}",
            f"{course}roll_rate_max_deg_s={cell['rate_deg_s']}",
            f"{course}height_agl_m={cell['height_m']}"]
    if args.pacing == "lockstep":  # equal flights on every machine
        sets += ["renderer.camera=raycast", "renderer.threads=1"]
    if cell["world"] == "builtin":
        sets.append(f"world.builtin.seed={cell['seed']}")
    if args.drop_every:
        fault = {"kind": "dropped_frames", "at_s": 0, "every": args.drop_every}
        sets.append(f"faults={json.dumps([fault])}")
    command = [args.binary, "run", ROOT / "scenarios" / SCENARIOS[cell["world"]], "--out", folder]
    for override in sets + args.set:
        command += ["--set", override]
    return command


def fly_once(target, command_into, known):
    """Flies `command_into(run folder)` and writes the essential results to the file `target`.

    @param known  added to the file
    """
    folder = target.parent / f"run_{target.stem}"
    shutil.rmtree(folder, ignore_errors=True)
    begin = time.monotonic()
    done = subprocess.run(command_into(folder), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    if done.returncode != 0:
        sys.exit(f"{target.stem}: the program ended with {done.returncode}\n{done.stdout[-2000:]}")
    metrics = json.loads((folder / "metrics.json").read_text())
    manifest = json.loads((folder / "manifest.json").read_text())
    result = {**known, "wall_s": round(time.monotonic() - begin, 1),
              "commit": manifest["commit"], "late_frames": metrics["camera"]["late_frames"],
              "estimator": next(iter(metrics["estimators"].values()))}
    written = target.with_suffix(".part")
    written.write_text(json.dumps(result))
    written.rename(target)
    shutil.rmtree(folder)
    return result


def fly(args, cell, mode, target):
    return fly_once(target, lambda folder: command_of(args, cell, folder), {**cell, "mode": mode})


def summary(result):
    estimator = result["estimator"]
    sim3 = estimator["alignments"].get("sim3", {})
    init = estimator["alignments"].get("init_scale", {})
    return {"outcome": estimator["outcome"], "coverage": 100.0 * estimator["coverage"],
            "start": estimator.get("initialised_at_s"), "sim3": sim3.get("position_rmse_m"),
            "init": init.get("position_rmse_m"), "rotation": init.get("rotation_rmse_deg"),
            "dropped": estimator["dropped_frames"], "late": result.get("late_frames", 0)}


def text_of(values, digits):
    """Median and worst; only the value if there is one."""
    known = [value for value in values if value is not None]
    if not known:
        return "-"
    if max(known) == 0:
        return "0"
    middle = f"{statistics.median(known):.{digits}f}"
    return middle if len(known) == 1 else f"{middle} / {max(known):.{digits}f}"


def within(cell, row):
    """True if a flight is within the limits: all of them at 150 to 400 m, the start at 100 m."""
    if cell["height_m"] < 100:
        return None
    limit_s = 1.5 if cell["height_m"] >= 150 else 3.0
    good = row["outcome"] == "COMPLETED" and row["start"] is not None and row["start"] <= limit_s
    if cell["height_m"] >= 150:
        good = (good and row["sim3"] <= LIMITS[cell["world"]] and row["init"] <= 2.0
                and row["rotation"] <= 0.05)
    return good


def table_lines(results):
    groups = {}
    for result in results:
        key = (result["mode"], result["world"], result["airspeed_m_s"], result["rate_deg_s"],
               result["height_m"])
        groups.setdefault(key, []).append(result)
    last = None
    paced = False
    for key in sorted(groups):
        group = groups[key]
        rows = [summary(result) for result in group]
        if key[:3] != last:
            last = key[:3]
            yield f"\n### {key[1]}, {key[2]} m/s, {key[0]}\n"
            commits = sorted({r["commit"] for k in groups if k[:3] == last for r in groups[k]})
            yield f"Flown by commit {', '.join(commits)}.\n"
            paced = not key[0].startswith("lockstep")
            yield ("| deg/s | height m | seeds | completed | coverage % | start s | Sim3 m "
                   "| `init_scale` m | rotation deg | within limits |"
                   + paced * (" lockstep Sim3 m | lockstep `init_scale` m | dropped | late |"))
            yield "|---|---|---|---|---|---|---|---|---|---|" + paced * "---|---|---|---|"
        completed = sum(row["outcome"] == "COMPLETED" for row in rows)
        others = sorted({row["outcome"] for row in rows} - {"COMPLETED"})
        verdicts = [within(result, row) for result, row in zip(group, rows)]
        met = "" if verdicts[0] is None else f"{sum(verdicts)}/{len(verdicts)}"
        in_lockstep = [summary(result) for result in groups.get(("lockstep", *key[1:]), [])]

        def column(field, digits, of=rows):
            return text_of([row[field] for row in of], digits)

        lowest = min(row["coverage"] for row in rows)
        yield (f"| {key[3]} | {key[4]} | {len(rows)} | {completed} {' '.join(others)} "
               f"| {lowest:.1f} | {column('start', 2)} | {column('sim3', 3)} "
               f"| {column('init', 3)} | {column('rotation', 3)} | {met} |"
               + paced * (f" {column('sim3', 3, in_lockstep)} | {column('init', 3, in_lockstep)} "
                          f"| {column('dropped', 0)} | {column('late', 0)} |"))


HEADER = """# Accuracy of the native estimator, cell by cell

Written by

    python3 tests/flights/accuracy.py build/release/overfly build/accuracy --seeds 101,102,103 \\
      --table docs/ACCURACY.md

This command flies the missing ones of the 48 cells (10 and 25 m/s; maximum roll rates of 25, 45, 65 deg/s; 50
to 400 m above ground). It flies them over the photograph of McMillan airfield (flat, 0.8 m per pixel) and over
the built-in world with its hills. It can be stopped and called again. **Cells that are not listed have not been
flown.**

Each flight is the course of 3.3 km, 1280x960 at 31 Hz, with noise of 1.5 grey levels, ray-caster and default
parameters. A seed determines the noise, the estimator's random numbers and the built-in world. Seeds below 100
were used for tuning, those from 101 on for these tables. Each value is the median over the seeds and, after the
slash, the worst; coverage is the lowest value, relative to all frames of the flight. Start is the time of the
first tracked pose. `init_scale` and rotation are aligned with the first tracked pose only.

The limits are: from 150 m up COMPLETED, start within 1.5 s, Sim3 at most 0.25 m (McMillan) or 0.5 m (hills),
`init_scale` at most 2 m, rotation at most 0.05 deg; at 100 m COMPLETED and start within 3 s; at 50 m none.

In real time, with all programs on the same two cores:

    python3 tests/flights/accuracy.py build/release/overfly build/accuracy --airspeeds 25 --heights 300 \\
      --rates 45,65 --seeds 101,102,103 --pacing real_time [--label 'at 20 Hz' \\
      --set 'estimators=[{"name":"feature","type":"feature","throttle_hz":20}]'] --table docs/ACCURACY.md

In these flights the backend is selected automatically. The lockstep columns repeat the values of the same cell
in lockstep. `dropped` frames arrived while the estimator was busy (at 20 Hz: throttled); `late` frames were not
rendered because the next one was already due. Each flight has 4092 frames.
"""


def text_kept(table):
    """What the file says after the tables, which other commands measured."""
    if not table.exists():
        return ""
    _, found, rest = table.read_text().partition(KEPT_FROM)
    return "\n" + found + rest if found else ""


def write_table(args):
    results = [json.loads(file.read_text()) for file in sorted(args.results.glob("*.json"))]
    count = len({(r["world"], r["airspeed_m_s"], r["rate_deg_s"], r["height_m"]) for r in results
                 if r["mode"] == "lockstep"})
    lines = [HEADER, f"{count} of 96 cells (48 over each of two worlds) in lockstep, "
             f"{len(results)} flights in all."]
    lines += table_lines(results)
    args.table.write_text("\n".join(lines) + "\n" + text_kept(args.table))
    print(f"{args.table}: {len(results)} flights")


def main():
    args = arguments()
    os.nice(10)
    args.results.mkdir(parents=True, exist_ok=True)
    mode = mode_of(args)
    flown = 0
    for cell in cells(args):
        target = args.results / f"{name_of(cell, mode)}.json"
        if flown >= args.most or target.exists():
            continue
        print(f"{target.stem} ...", flush=True)
        row = summary(fly(args, cell, mode, target))
        print("  " + ", ".join(f"{key} {value}" for key, value in row.items()), flush=True)
        flown += 1
    if args.table:
        write_table(args)


if __name__ == "__main__":
    main()
