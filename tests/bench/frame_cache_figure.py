#!/usr/bin/env python3
"""How much a frame cache saves: a flight without one, with an empty one and with one that has its pictures.

Flies the first seconds of a scenario with two cameras (one that gives the rendered picture, one with noise and the
other effects of a sensor) and two estimators, without and with a cache in turn, and prints the processor and wall time
of each and the size of the cache. Every flight must give the same frames and estimates.

    tests/bench/frame_cache_figure.py build/release/overfly [--scenario F] [--seconds 10] [--rounds 3]
        [--camera NAME]... [--estimator TYPE]... [--set PATH=VALUE]...
"""

import argparse
import hashlib
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

SENSOR = {
    "vignette": [-0.35, 0.05, 0], "exposure_ms": 2, "motion_blur": True, "electrons_per_s": 5000000,
    "shot_noise": True, "prnu": 0.01, "dsnu_e": 3, "full_well_e": 11000, "read_noise_e": 8,
    "auto_exposure": {"target_mean": 0.42, "max_exposure_ms": 8},
}
CAMERAS = {
    "ideal": [],
    "realistic": ["camera.sensor=" + json.dumps(SENSOR)],
    "rolling": ["camera.sensor=" + json.dumps({**SENSOR, "readout_ms": 15})],
    "light": ["camera.sensor={}"],
    "colour": ["camera.color=rgb"],
}


def fly(binary, scenario, sets, folder, cache, gib):
    words = [binary, "run", scenario, "--out", str(folder), "--quiet"]
    for field in sets:
        words += ["--set", field]
    if cache is not None:
        words += ["--frame-cache", str(cache), "--frame-cache-gib", str(gib)]
    begin = time.monotonic()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    wall_s = time.monotonic() - begin
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(words)} ended with {process.returncode}")
    timings = json.loads((folder / "timings.json").read_text())
    digest = hashlib.sha256()
    for file in sorted(folder.rglob("*")):
        if file.is_file() and file.name not in ("timings.json", "created.json"):
            digest.update(file.read_bytes())
    return {"user_s": usage.ru_utime, "system_s": usage.ru_stime, "wall_s": wall_s,
            "loop_s": timings["loop_wall_s"], "use": timings.get("frame_cache"), "digest": digest.hexdigest(),
            "render_ms": timings["stages"]["render"]["median_ms"], "frames": timings["stages"]["render"]["count"]}


def measure(arguments, camera, estimator):
    sets = [f"duration_s={arguments.seconds}", *CAMERAS[camera], *arguments.set,
            "estimators=" + json.dumps([{"name": "e", "type": estimator}])]
    flights = {"without": [], "empty": [], "warm": []}
    cache_mb = []
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for number in range(arguments.rounds):
            cache = root / f"cache{number}"
            for kind in flights:
                flown = fly(arguments.binary, arguments.scenario, sets, root / f"{kind}{number}",
                            None if kind == "without" else cache, arguments.gib)
                flights[kind].append(flown)
                if kind == "warm" and flown["use"]["rendered"]:
                    print(f"note: {flown['use']}")
            cache_mb.append(sum(f.stat().st_size for f in cache.rglob("*.frame")) / 1e6)
            subprocess.run(["rm", "-rf", cache], check=True)
        if len({flown["digest"] for kind in flights.values() for flown in kind}) != 1:
            raise SystemExit("the run folders differ")
    median = {kind: {name: statistics.median(flown[name] for flown in flown_of)
                     for name in ("user_s", "system_s", "wall_s", "loop_s", "render_ms", "frames")}
              for kind, flown_of in flights.items()}
    for kind, values in median.items():
        ratio = {name: values[name] / median["without"][name] for name in ("user_s", "wall_s", "loop_s")}
        print(f"{camera:10} {estimator:14} {kind:8} user {values['user_s']:6.2f} s ({ratio['user_s']:.2f})  "
              f"system {values['system_s']:5.2f} s  wall {values['wall_s']:6.2f} s ({ratio['wall_s']:.2f})  "
              f"frames alone {values['loop_s']:6.2f} s ({ratio['loop_s']:.2f})  "
              f"picture {values['render_ms']:6.2f} ms", flush=True)
    megabytes = statistics.median(cache_mb)
    print(f"{camera:10} {estimator:14} cache {megabytes:.0f} MB, {megabytes / median['warm']['frames']:.2f} MB a frame; "
          f"added {[flown['use']['added'] for flown in flights['empty']]} of {median['warm']['frames']:.0f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("--scenario", default="scenarios/course.json")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--gib", type=float, default=8)
    parser.add_argument("--camera", action="append", choices=CAMERAS)
    parser.add_argument("--estimator", action="append")
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()
    for camera in arguments.camera or ["ideal", "realistic"]:
        for estimator in arguments.estimator or ["feature", "baseline_hold"]:
            measure(arguments, camera, estimator)


if __name__ == "__main__":
    main()
