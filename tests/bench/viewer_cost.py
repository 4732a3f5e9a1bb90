#!/usr/bin/env python3
"""What a viewer costs a flight in real time: late and dropped frames without one and with one.

Flies the first seconds of a scenario in real time with the estimator `feature`, in turns without a
viewer, with a client that takes all pictures of the flight, and with the dashboard in headless
Chromium on this machine, and prints what each flight lost.

    tests/bench/viewer_cost.py build/release/overfly [--seconds 25] [--turns 2] [--viewers none,browser]
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

from stream_figure import WebSocket, cpu_seconds

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHROMIUM = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
            "--disable-background-networking", "--disable-component-update", "--disable-sync",
            "--window-size=1600,1000", "--remote-debugging-port=0"]


class Server:
    def __init__(self, program, folder):
        self.runs = pathlib.Path(folder) / "runs"
        self.process = subprocess.Popen(
            [program, "serve", "--port", "0", "--runs", self.runs, "--scenarios",
             ROOT / "scenarios", "--web", ROOT / "web/dist"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.port, self.token = re.search(r":(\d+)/\?token=(\S+)",
                                          self.process.stdout.readline()).groups()

    def ask(self, path, body=None):
        request = urllib.request.Request(
            f"http://127.0.0.1:{self.port}/api/v1{path}",
            data=None if body is None else json.dumps(body).encode(),
            headers={"Content-Type": "application/json", "Authorization": f"Bearer {self.token}"})
        return json.load(urllib.request.urlopen(request))

    def stop(self):
        self.process.terminate()
        self.process.wait()


def take_pictures(server, run):
    client = WebSocket(int(server.port), server.token)
    client.send({"type": "view", "mode": "chase", "width_px": 960, "height_px": 720})
    client.send({"type": "subscribe", "pictures": [
        {"run": run, "name": "camera", "max_hz": 31}, {"run": run, "name": "scene", "max_hz": 15},
        {"run": run, "name": "debug/feature", "max_hz": 15}]})
    client.send({"type": "watch", "run": run})
    try:
        while client.receive()[0] != 8:
            pass
    except (OSError, ValueError):
        pass  # The server has ended.


def open_browser(server, run, folder):
    url = f"http://127.0.0.1:{server.port}/?token={server.token}#run={run}"
    return subprocess.Popen([*CHROMIUM, f"--user-data-dir={folder}/profile", url],
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                            start_new_session=True)


def fly(program, scenario, seconds, viewer):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        server = Server(program, folder)
        browser = None
        try:
            run = server.ask("/runs", {"scenario": scenario, "overrides": {
                "pacing": "real_time", "duration_s": seconds}})["id"]
            if viewer == "client":
                threading.Thread(target=take_pictures, args=(server, run), daemon=True).start()
            elif viewer == "browser":
                browser = open_browser(server, run, folder)
            cpu = begin = None
            while (info := server.ask(f"/runs/{run}"))["status"] in ("queued", "running"):
                if begin is None and info["frames"] > 0:
                    begin, cpu = time.monotonic(), cpu_seconds(server.process.pid)
                time.sleep(0.5)
            cores = (cpu_seconds(server.process.pid) - cpu) / (time.monotonic() - begin)
            metrics = json.loads((server.runs / run / "metrics.json").read_text())
            timings = json.loads((server.runs / run / "timings.json").read_text())
        finally:
            if browser:
                os.killpg(browser.pid, signal.SIGKILL)
                browser.wait()
            server.stop()
    late = metrics["camera"]["late_frames"]
    seen = timings.get("viewers") or {}
    print(f"{viewer:8s} late {late:4d} of {late + metrics['camera']['frames']:4d}   "
          f"dropped {metrics['estimators']['feature']['dropped_frames']:3d}   "
          f"{metrics['estimators']['feature']['outcome']}   server {cores:.2f} of "
          f"{os.cpu_count()} cores   pictures {json.dumps(seen.get('pictures'))} for "
          f"{seen.get('cpu_s', 0.0):.1f} s of CPU   load {os.getloadavg()[0]:.1f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--scenario", default="course")
    parser.add_argument("--seconds", type=float, default=25.0)
    parser.add_argument("--turns", type=int, default=2)
    parser.add_argument("--viewers", default="none,client,browser")
    arguments = parser.parse_args()
    viewers = arguments.viewers.split(",")
    if "browser" in viewers and not shutil.which("chromium"):
        sys.exit("chromium is not installed: leave out the browser with --viewers none,client")
    for _ in range(arguments.turns):
        for viewer in viewers:
            fly(arguments.program, arguments.scenario, arguments.seconds, viewer)


if __name__ == "__main__":
    main()
