#!/usr/bin/env python3
"""Time from a live vehicle's message to the rendered frame.

Flies the built-in vehicle's take-off and pattern in a scenario, and prints the figures of the run's
timings.json and the camera's period.
Usage: live_latency.py OVERFLY [SECONDS] [SETTING...]
SETTINGs are passed on as --set, after estimators=[]: "camera.width_px=640", "pacing=real_time".
"""

import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main():
    overfly, *rest = sys.argv[1:]
    seconds = float(rest[0]) if rest else 30.0
    settings = rest[1:]
    with tempfile.TemporaryDirectory() as folder:
        vehicle = subprocess.Popen(
            [overfly, "vehicle", "--link", "tcp-listen:127.0.0.1:0"],
            stdout=subprocess.PIPE, text=True)
        try:
            # "vehicle 1.1 (NAME) on tcp-listen:127.0.0.1:PORT"
            port = vehicle.stdout.readline().rsplit(":", 1)[1].strip()
            command = [overfly, "run", str(ROOT / "scenarios" / "course.json"),
                       "--out", folder + "/run"]
            for setting in [
                    "flight.mavlink.link=tcp:127.0.0.1:" + port,
                    "flight.mavlink.mission_file=./missions/airfield_pattern.waypoints",
                    "flight.mavlink.arm_and_start=true",
                    "estimators=[]",
                    f"duration_s={seconds}", *settings]:
                command += ["--set", setting]
            run = subprocess.run(command, capture_output=True, text=True)
            if run.returncode != 0:
                sys.exit(run.stderr or run.stdout)
        finally:
            vehicle.terminate()
            vehicle.wait()
        timings = json.loads(pathlib.Path(folder, "run", "timings.json").read_text())
        manifest = json.loads(pathlib.Path(folder, "run", "manifest.json").read_text())
    latency = timings["message_to_frame"]
    camera = manifest["camera"]
    print(f"{manifest['renderer']['backend']}, {manifest['renderer']['device']}, "
          f"{camera['width_px']}x{camera['height_px']}, {manifest['pacing']}: "
          f"{latency['count']} frames of {1000.0 / camera['rate_hz']:.1f} ms; message to frame "
          f"median {latency['median_ms']:.1f} ms, p95 {latency['p95_ms']:.1f} ms, "
          f"p99 {latency['p99_ms']:.1f} ms, longest {latency['max_ms']:.1f} ms")


main()
