#!/usr/bin/env python3
"""Flies the short flights that the risk model of `overfly predict` is fitted to and judged by.

Usage: predict_flights.py BINARY RESULTS_FOLDER [--data FOLDER] [--fitting N] [--judging N]
           [--jobs N]

Flies --fitting and --judging flights over the two sets of worlds (predict_worlds.py), of 10 s with the
native estimator in lockstep. Height, speed, turns, camera, exposure, noise, focus and light are drawn at random from
the same ranges for both sets; the number of a flight determines them. RESULTS_FOLDER/flights gets a
scenario and a result for each; flights that have a result are skipped. The flights of the two sets
alternate.
"""

import argparse
import concurrent.futures
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
import time

from predict_worlds import FITTING, JUDGING, WorldMaker

ROOT = pathlib.Path(__file__).resolve().parents[2]
DURATION_S = 10


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path, default=ROOT / "../shared/data")
    parser.add_argument("--fitting", type=int, default=168)
    parser.add_argument("--judging", type=int, default=84)
    parser.add_argument("--jobs", type=int, default=2)
    return parser.parse_args()


def log_uniform(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def drawn_scenario(rng, world):
    """A flight of random height, speed, turns, camera and light."""
    width = rng.choice([200, 240, 320])
    rate_hz = rng.randint(8, 16)
    exposure_ms = min(log_uniform(rng, 0.5, 60), 900 / rate_hz)
    electrons = log_uniform(rng, 100, 30000)
    sensor = {"motion_blur": True, "exposure_ms": round(exposure_ms, 2), "shot_noise": True,
              "electrons_per_s": round(electrons / exposure_ms * 1e3),
              "read_noise_e": round(rng.uniform(0, 20), 1), "response": {"shape": "srgb"}}
    if rng.random() < 0.25:
        sensor["defocus_sigma_px"] = round(rng.uniform(0.5, 5), 2)
    scenario = {
        "format_version": 1,
        "seed": rng.randint(1, 10**6),
        "world": world,
        "flight": {"course": {
            "airspeed_m_s": round(rng.uniform(12, 35), 1),
            "roll_rate_max_deg_s": round(log_uniform(rng, 20, 190), 1),
            "height_agl_m": round(log_uniform(rng, 25, 600)),
            "bank_max_deg": round(rng.uniform(15, 65)),
            "length_m": 500,
            "leg_length_m": round(rng.uniform(20, 120)),
            "start": {"east_m": round(rng.uniform(-250, 250)),
                      "north_m": round(rng.uniform(-250, 250))},
            "heading_deg": round(rng.uniform(0, 359))}},
        "duration_s": DURATION_S,
        "camera": {"width_px": width, "height_px": width * 3 // 4,
                   "fov_deg": round(rng.uniform(55, 95), 1), "rate_hz": rate_hz, "sensor": sensor},
        "renderer": {"camera": "raycast", "threads": 1},
        "estimators": [{"name": "feature", "type": "feature"}],
        "recording": {"debug_hz": 0}}
    if rng.random() < 0.25:
        scenario["light"] = {"sun_azimuth_deg": round(rng.uniform(0, 359)),
                             "sun_elevation_deg": round(rng.uniform(4, 50), 1),
                             "hill_shading": 1, "cast_shadows": 1}
    return scenario


def flown(binary, scenario_file, run):
    shutil.rmtree(run, ignore_errors=True)
    start = time.monotonic()
    done = subprocess.run([str(binary), "run", str(scenario_file), "--out", str(run), "--quiet"],
                          capture_output=True, text=True)
    if done.returncode != 0:
        return {"error": (done.stdout + done.stderr)[-500:]}
    score = json.loads((run / "metrics.json").read_text())["estimators"]["feature"]
    return {key: score.get(key) for key in
            ("outcome", "outcome_time_s", "initialised_at_s", "coverage")} | {
                "wall_s": round(time.monotonic() - start, 1)}


def fly(args, maker_world, set_name, name, number):
    flights = args.results / "flights"
    result_file = flights / f"{set_name}_{number:03d}.result.json"
    if result_file.exists():
        return
    scenario_file = flights / f"{set_name}_{number:03d}.scenario.json"
    rng = random.Random(f"{set_name} {number}")
    scenario_file.write_text(json.dumps(drawn_scenario(rng, maker_world), indent=1))
    run = args.results / "runs" / f"{set_name}_{number:03d}"
    result = {"set": set_name, "world": name, "number": number,
              **flown(args.binary, scenario_file, run)}
    shutil.rmtree(run, ignore_errors=True)
    if "error" not in result:
        result_file.write_text(json.dumps(result))
    print(f"{set_name} {number} {name}: {result.get('outcome', result.get('error'))} "
          f"{result.get('wall_s')} s", file=sys.stderr, flush=True)


def main():
    args = arguments()
    (args.results / "flights").mkdir(parents=True, exist_ok=True)
    maker = WorldMaker(args.binary, args.results / "worlds", args.data)
    tasks = []
    for number in range(max(args.fitting, args.judging)):
        for set_name, worlds, count in (("fit", FITTING, args.fitting),
                                        ("judge", JUDGING, args.judging)):
            if number >= count:
                continue
            name = list(worlds)[number % len(worlds)]
            tasks.append((maker.world(name), set_name, name, number))
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for done in [pool.submit(fly, args, *task) for task in tasks]:
            done.result()


if __name__ == "__main__":
    main()
