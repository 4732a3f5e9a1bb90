#!/usr/bin/env python3
"""Flies the short flights of docs/PERFORMANCE.md and prints their tables.

Usage: short_flights.py BINARY RESULTS_FOLDER [--tables switches,height,darkness,mounts]

  switches   each parameter of the native estimator for flight over land, on and off
  height     the initial height above ground, which gives the scale, given and not given
  darkness   no light in the middle of a flight, straight and in a turn
  mounts     cameras that do not look straight down

10 to 14 s each, with the noise, renderer and pacing of accuracy.py. Each flight leaves
RESULTS_FOLDER/NAME.json; flights that have a result are skipped.
"""

import argparse
import itertools
import json
import pathlib
import sys
from dataclasses import dataclass, field, replace

from accuracy import NOISE, ROOT, SCENARIOS, fly_once


@dataclass(frozen=True)
class Flight:
    """Over one world, with a first turn after 75 m unless it is straight."""
    name: str
    world: str
    rate_deg_s: int = 45
    height_m: int = 300
    duration_s: int = 12
    seed: int = 201
    world_seed: int = 1
    straight: bool = False
    faults: tuple = ()
    camera: dict = field(default_factory=dict)
    parameters: dict = field(default_factory=dict)

    def command(self, binary, folder):
        course = "flight.course."
        estimator = {"name": "feature", "type": "feature", "parameters": self.parameters}
        sets = {"seed": self.seed, "duration_s": self.duration_s, "pacing": "lockstep",
                "renderer.camera": "raycast", "camera.sensor": json.dumps(NOISE),
                course + "airspeed_m_s": 25, course + "roll_rate_max_deg_s": self.rate_deg_s,
                course + "height_agl_m": self.height_m,
                course + "leg_length_m": 1000 if self.straight else 75,
                "faults": json.dumps(self.faults), "estimators": json.dumps([estimator])}
        if self.world == "builtin":
            sets["world.builtin.seed"] = self.world_seed
        sets.update({f"camera.{key}": value for key, value in self.camera.items()})
        command = [binary, "run", ROOT / "scenarios" / SCENARIOS[self.world], "--out", folder]
        for key, value in sets.items():
            command += ["--set", f"{key}={value}"]
        return command


def fly(binary, results, flight):
    """The estimator's part of the metrics, and the commit that flew it."""
    target = results / f"{flight.name}.json"
    if target.exists():
        result = json.loads(target.read_text())
    else:
        print(f"{flight.name} ...", file=sys.stderr, flush=True)
        result = fly_once(target, lambda folder: flight.command(binary, folder), {})
    return result["estimator"], result["commit"]


def metres(estimator, alignment):
    value = estimator["alignments"].get(alignment, {}).get("position_rmse_m")
    return "-" if value is None else f"{value:.3f}"


def cells_of(estimator):
    start_s = estimator.get("initialised_at_s")
    start = "-" if start_s is None else f"{start_s:.2f}"
    without = estimator["frames"] - estimator["tracked_frames"]
    return [estimator["outcome"], start, f"{without} of {estimator['frames']}",
            metres(estimator, "sim3"), metres(estimator, "init_scale")]


RESULT_COLUMNS = ["outcome", "start s", "frames without a pose", "Sim3 m", "`init_scale` m"]


def burst(at_s, duration_s, strength, radius_px):
    return ({"kind": "saturation_burst", "at_s": at_s, "duration_s": duration_s,
             "strength": strength, "radius_px": radius_px},)


SLOW = {"camera": {"rate_hz": 6}, "duration_s": 14, "rate_deg_s": 65}
EVERY_THIRD = ({"kind": "dropped_frames", "at_s": 0, "every": 3},)

# Parameter that is switched off, flight, what it is in words.
SWITCHES = [
    ("planar_start", Flight("planar", "mcmillan", duration_s=4), "45 deg/s, first 4 s"),
    ("rotation_compensation", Flight("turn", "mcmillan", 65), "65 deg/s"),
    ("rotation_compensation", Flight("turn_dropped", "mcmillan", 65, faults=EVERY_THIRD),
     "65 deg/s, one frame in three dropped"),
    ("rotation_compensation",
     Flight("turn_10hz", "mcmillan", 65, duration_s=14, camera={"rate_hz": 10}), "65 deg/s, 10 Hz"),
    *(("rotation_compensation", Flight(f"turn_6hz_{seed}", "mcmillan", seed=seed, **SLOW),
       f"65 deg/s, 6 Hz, seed {seed}") for seed in (201, 202, 203)),
    *(("rotation_compensation", Flight(f"turn_6hz_world{seed}", "builtin", world_seed=seed,
                                       **SLOW),
       f"65 deg/s, 6 Hz, world {seed}") for seed in (1, 2)),
    ("low_texture", Flight("low", "mcmillan", height_m=50), "45 deg/s, 50 m"),
    ("reject_saturated", Flight("burst", "builtin", world_seed=2, straight=True,
                                faults=burst(5, 2, 4, 300)),
     "straight, world 2, burst of 300 px from 5 to 7 s"),
    *(("reject_saturated",
       Flight(f"burst_{radius_px}px", "builtin", world_seed=2, duration_s=10,
              faults=burst(at_s, lasts_s, strength, radius_px)),
       f"45 deg/s, world 2, burst of {radius_px} px from {at_s} to {at_s + lasts_s} s")
      for at_s, lasts_s, strength, radius_px in ((0, 3, 10, 300), (0, 3, 4, 400), (4, 4, 20, 500))),
]


def name_of(world):
    return "McMillan" if world == "mcmillan" else "built-in"


def switches(fly_one):
    yield ["parameter", "flight", "", *RESULT_COLUMNS]
    for parameter, flight, words in SWITCHES:
        for is_on in (True, False):
            name = f"{flight.name}_{'on' if is_on else 'without_' + parameter}"
            changed = replace(flight, name=name, parameters={} if is_on else {parameter: False})
            yield [f"`{parameter}`", f"{name_of(flight.world)}, {words}", "on" if is_on else "off",
                   *cells_of(fly_one(changed))]


def height(fly_one):
    """SE3 fits no scale, so its residual includes the error of the given height."""
    yield ["`initial_height_m`", "world", *RESULT_COLUMNS, "SE3 m"]
    for world in ("mcmillan", "builtin"):
        for told_m in (0, 300):
            flight = Flight(f"height_{world}_{told_m}", world,
                            parameters={"initial_height_m": told_m})
            estimator = fly_one(flight)
            yield [str(told_m), name_of(world), *cells_of(estimator), metres(estimator, "se3")]


def darkness(fly_one):
    yield ["world", "flight", "dark from 4 s on for", *RESULT_COLUMNS]
    for world, straight, lasts_s in itertools.product(("mcmillan", "builtin"), (True, False), (1, 2, 4)):
        fault = {"kind": "blackout", "at_s": 4, "duration_s": lasts_s}
        flight = Flight(f"dark_{world}_{'straight' if straight else 'turn'}_{lasts_s}s", world,
                        straight=straight, faults=(fault,))
        yield [name_of(world), "straight on" if straight else "first turn and reversals",
               f"{lasts_s} s", *cells_of(fly_one(flight))]


MOUNTS = [("pitched up by 20 deg", {"mount.pitch_deg": 20}),
          ("pitched down by 30 deg", {"mount.pitch_deg": -30}),
          ("rolled by 20 deg", {"mount.roll_deg": 20}),
          ("forward, 40 deg below the horizon", {"mount.facing": "forward", "mount.pitch_deg": -40}),
          ("forward, 20 deg below the horizon", {"mount.facing": "forward", "mount.pitch_deg": -20})]


def mounts(fly_one):
    yield ["mount", "world", *RESULT_COLUMNS]
    for index, (words, camera) in enumerate(MOUNTS):
        for world in ("mcmillan", "builtin"):
            flight = Flight(f"mount{index}_{world}", world, camera=camera)
            yield [words, name_of(world), *cells_of(fly_one(flight))]


def main():
    tables = {"switches": switches, "height": height, "darkness": darkness, "mounts": mounts}
    parser = argparse.ArgumentParser()
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--tables", default=list(tables), type=lambda text: text.split(","))
    args = parser.parse_args()
    if unknown := set(args.tables) - set(tables):
        parser.error(f"--tables {','.join(sorted(unknown))}: known are {', '.join(tables)}")
    args.results.mkdir(parents=True, exist_ok=True)
    commits = set()

    def fly_one(flight):
        estimator, commit = fly(args.binary, args.results, flight)
        commits.add(commit)
        return estimator

    for name in args.tables:
        print(f"\n### {name}\n")
        for number, row in enumerate(tables[name](fly_one)):
            print("|", " | ".join(row), "|", flush=True)
            if number == 0:
                print("|" + "---|" * len(row))
    print(f"\nFlown by commit {', '.join(sorted(commits))}.")


if __name__ == "__main__":
    main()
