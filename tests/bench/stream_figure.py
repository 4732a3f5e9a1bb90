#!/usr/bin/env python3
"""How fast camera imagery is made and the chase view streams while a run is live.

Starts `overfly serve` on a free loopback port, flies a scenario in real time with a 31 Hz
1280 x 960 camera and no estimator, one client watches the camera and the chase view
(960 x 720), and prints the rates over a span of the flight, after the tiles are warm.

    tests/bench/stream_figure.py build/release/overfly [--scenario course] [--seconds 20]
"""

import argparse
import base64
import json
import os
import re
import socket
import struct
import subprocess
import tempfile
import time
import urllib.request

HEADER = struct.Struct("<IHHIIqqHHHHII")


class WebSocket:
    """The little of RFC 6455 that a client of one trusted server needs."""

    def __init__(self, port, token):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            (f"GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
             f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
             f"Authorization: Bearer {token}\r\n"
             "Sec-WebSocket-Version: 13\r\n\r\n").encode())
        self.stream = self.socket.makefile("rb")
        while self.stream.readline() not in (b"\r\n", b""):
            pass

    def send(self, message, opcode=1):
        data = json.dumps(message).encode() if opcode == 1 else message
        length = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack(">H", len(data))
        self.socket.sendall(bytes([0x80 | opcode]) + length + bytes(4) + data)

    def receive(self):
        """The next message: (opcode, bytes)."""
        while True:
            first, second = self.stream.read(2)
            length = second & 0x7F
            if length == 126:
                length = struct.unpack(">H", self.stream.read(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self.stream.read(8))[0]
            data = self.stream.read(length)
            if first & 0x0F == 9:
                self.send(data, opcode=10)
            else:
                return first & 0x0F, data


def cpu_seconds(pid):
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def start_run(port, token, scenario):
    overrides = {"pacing": "real_time", "estimators": [], "camera.width_px": 1280,
                 "camera.height_px": 960, "camera.rate_hz": 31}
    request = urllib.request.Request(
        f"http://127.0.0.1:{port}/api/v1/runs", method="POST",
        data=json.dumps({"scenario": scenario, "overrides": overrides}).encode(),
        headers={"Content-Type": "application/json", "Authorization": f"Bearer {token}"})
    return json.load(urllib.request.urlopen(request))["id"]


def measure(port, token, pid, run, warm_s, span_s):
    client = WebSocket(port, token)
    client.send({"type": "view", "mode": "chase", "width_px": 960, "height_px": 720})
    client.send({"type": "subscribe", "pictures": [
        {"run": run, "name": "camera", "max_hz": 31}, {"run": run, "name": "scene", "max_hz": 15}]})
    client.send({"type": "watch", "run": run})
    names, pictures, sizes, stamps = {}, {}, {}, []
    begin = None
    while True:
        opcode, data = client.receive()
        now = time.monotonic()
        if begin is None and stamps:
            begin = now + warm_s
            cpu = None
        if begin is not None and now >= begin and cpu is None:
            cpu, pictures, sizes, stamps = cpu_seconds(pid), {}, {}, stamps[-1:]
        if begin is not None and now >= begin + span_s:
            break
        if opcode == 1:
            message = json.loads(data)
            if message["type"] == "pictures":
                names = {picture["id"]: picture["name"] for picture in message["pictures"]}
            elif message["type"] == "rows" and message["stream"] == "truth":
                stamps += message["columns"]["t_ns"]
            elif message["type"] == "error":
                raise SystemExit(message["message"])
        elif opcode == 2:
            name = names[HEADER.unpack_from(data)[3]]
            pictures[name] = pictures.get(name, 0) + 1
            sizes[name] = sizes.get(name, 0) + len(data)
        else:
            raise SystemExit("the connection ended")
    print(f"camera frames made        {(len(stamps) - 1) / span_s:6.1f} Hz (1280 x 960, asked for 31)")
    print(f"flight time per wall time {(stamps[-1] - stamps[0]) / 1e9 / span_s:6.2f}")
    for name in sorted(pictures):
        print(f"{name + ' pictures received':25s} {pictures[name] / span_s:6.1f} Hz, "
              f"{sizes[name] / pictures[name] / 1024:.0f} KiB each")
    print(f"CPU time per wall time    {(cpu_seconds(pid) - cpu) / span_s:6.2f} of {os.cpu_count()} cores, "
          f"load average {os.getloadavg()[0]:.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--scenario", default="course")
    parser.add_argument("--scenarios", default=os.path.join(os.path.dirname(__file__), "../../scenarios"))
    parser.add_argument("--warm", type=float, default=5.0)
    parser.add_argument("--seconds", type=float, default=20.0)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        server = subprocess.Popen([arguments.program, "serve", "--port", "0", "--runs", folder,
                                   "--scenarios", arguments.scenarios], stdout=subprocess.PIPE, text=True)
        try:
            port, token = re.search(r":(\d+)/\?token=(\S+)", server.stdout.readline()).groups()
            run = start_run(port, token, arguments.scenario)
            measure(port, token, server.pid, run, arguments.warm, arguments.seconds)
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
