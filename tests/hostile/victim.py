"""The real server with a small world, a secret next to its folders, and a listener that the server must
not connect to."""

import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time

START_S = 60
STOP_S = 20
ANSWER_S = 60
SECRET = "the-secret-of-the-machine-7f3a"


def texture(x, y):
    return (7 * x + 13 * y + (x * y) % 31) % 256


def gentle_slope(x, _y):
    return 100 + x // 16


def write_geotiff(path, width_px, height_px, metres_per_pixel, east_m, north_m, value_at=texture):
    """A grey picture in EPSG:32610 (UTM zone 10), written by hand from the TIFF 6 and GeoTIFF 1.1
    standards, so that the test needs no imaging library."""
    pixels = bytes(value_at(x, y) for y in range(height_px) for x in range(width_px))
    keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32610)
    scale = struct.pack("<3d", metres_per_pixel, metres_per_pixel, 0.0)
    tie = struct.pack("<6d", 0, 0, 0, east_m, north_m, 0)
    entries = 12
    data_at = 8 + 2 + entries * 12 + 4
    scale_at, tie_at = data_at, data_at + len(scale)
    keys_at = tie_at + len(tie)
    pixels_at = keys_at + len(keys)
    short, long, double = 3, 4, 12

    def entry(tag, kind, count, value):
        return struct.pack("<HHII", tag, kind, count, value)

    directory = b"".join([
        entry(256, long, 1, width_px), entry(257, long, 1, height_px), entry(258, short, 1, 8),
        entry(259, short, 1, 1), entry(262, short, 1, 1), entry(273, long, 1, pixels_at),
        entry(277, short, 1, 1), entry(278, long, 1, height_px), entry(279, long, 1, len(pixels)),
        entry(33550, double, 3, scale_at), entry(33922, double, 6, tie_at),
        entry(34735, short, 16, keys_at)])
    path.write_bytes(b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", entries) + directory +
                     struct.pack("<I", 0) + scale + tie + keys + pixels)


def write_endless_geotiff(path, side_px):
    """A BigTIFF of small tiles, none of them written: many blocks to examine in a sparse file. Keys and
    place are those of write_geotiff."""
    tile_px = 16
    tiles = (-(-side_px // tile_px)) ** 2
    keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32610)
    scale = struct.pack("<3d", 4.0, 4.0, 0.0)
    tie = struct.pack("<6d", 0, 0, 0, 600000.0, 4200000.0, 0)
    entries = 13
    scale_at = 16 + 8 + entries * 20 + 8
    tie_at = scale_at + len(scale)
    keys_at = tie_at + len(tie)
    offsets_at = 4096
    sizes_at = offsets_at + 8 * tiles
    short, long, double, long8 = 3, 4, 12, 16
    directory = b"".join(struct.pack("<HHQQ", *entry) for entry in [
        (256, long, 1, side_px), (257, long, 1, side_px), (258, short, 1, 8), (259, short, 1, 1),
        (262, short, 1, 1), (277, short, 1, 1), (322, short, 1, tile_px), (323, short, 1, tile_px),
        (324, long8, tiles, offsets_at), (325, long8, tiles, sizes_at),
        (33550, double, 3, scale_at), (33922, double, 6, tie_at), (34735, short, 16, keys_at)])
    with open(path, "wb") as file:
        file.write(b"II+\0" + struct.pack("<HHQQ", 8, 0, 16, entries) + directory +
                   struct.pack("<Q", 0) + scale + tie + keys)
        file.truncate(sizes_at + 8 * tiles)


class Listener:
    """Accepts connections on loopback, answers HTTP, and records the requests."""

    def __init__(self):
        self.calls = []
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.port = self._socket.getsockname()[1]
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def _serve(self):
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:
                return
            with connection:
                connection.settimeout(2)
                try:
                    self.calls.append(connection.recv(4096))
                    connection.sendall(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n")
                except OSError:
                    self.calls.append(b"(no request)")

    def close(self):
        self._socket.close()


class Answer:
    def __init__(self, status, headers, body):
        self.status = status
        self.headers = headers
        self.body = body

    @property
    def text(self):
        return self.body.decode("utf-8", "replace")

    def json(self):
        return json.loads(self.body)


class Victim:
    """The server under attack, on a free port of loopback, with its own folders."""

    def __init__(self, program, arguments=(), folder=None):
        self.program = program
        self._owns_folder = folder is None
        self.folder = folder or pathlib.Path(tempfile.mkdtemp(prefix="overfly-hostile-"))
        self.runs = self.folder / "runs"
        self.scenarios = self.folder / "scenarios"
        self.data = self.scenarios / "data"
        self.outside = self.folder / "outside"
        if self._owns_folder:
            self._make_folders()
        self._log = open(self.folder / "server.log", "ab")
        self._start(list(arguments))

    def _make_folders(self):
        for folder in (self.runs, self.data, self.outside, self.folder / "web"):
            folder.mkdir(parents=True)
        (self.folder / "web" / "index.html").write_text("<!doctype html><title>page</title>")
        write_geotiff(self.data / "ground.tif", 256, 256, 4.0, 600000.0, 4200000.0)
        write_geotiff(self.data / "heights.tif", 256, 256, 4.0, 600000.0, 4200000.0, gentle_slope)
        (self.outside / "secret.txt").write_text(SECRET + "\n")
        write_geotiff(self.outside / "secret.tif", 64, 64, 4.0, 600000.0, 4200000.0)
        world = {"format_version": 1, "imagery": [{"file": "ground.tif"}], "ground_height_m": 100}
        (self.data / "world.json").write_text(json.dumps(world))
        common = {
            "format_version": 1,
            "data": "data",
            "camera": {"width_px": 64, "height_px": 48, "rate_hz": 5},
            "duration_s": 1,
            "flight": {"course": {}},
            "estimators": [{"name": "perfect", "type": "perfect"}],
        }
        listed = {"imagery": [{"file": "ground.tif"}], "ground_height_m": 100}
        self.write_scenario("listed", {**common, "world": listed})
        self.write_scenario("manifest", {**common, "world": {"manifest": "world.json"}})
        (self.data / "flight.tum").write_text(
            "".join(f"{0.1 * k:.1f} {2.5 * k:.1f} 0 400 0 0 0 1\n" for k in range(60)))
        self.write_scenario("logged", {**common, "world": listed,
                                       "flight": {"log": {"file": "flight.tum"}}})
        # Opening the first takes minutes; the second has 20 GB and uses no disk space.
        write_endless_geotiff(self.data / "endless.tif", 100_000)
        with open(self.data / "sparse.txt", "wb") as sparse:
            sparse.truncate(20 << 30)
        os.mkfifo(self.data / "fifo")
        (self.data / "loop").symlink_to("loop")
        (self.data / "link_out.txt").symlink_to(self.outside / "secret.txt")
        (self.data / "link_out.tif").symlink_to(self.outside / "secret.tif")

    def write_scenario(self, name, document):
        (self.scenarios / f"{name}.json").write_text(json.dumps(document))

    def _start(self, arguments):
        command = [self.program, "serve", "--port", "0", "--runs", str(self.runs), "--scenarios",
                   str(self.scenarios), "--web", str(self.folder / "web"), *arguments]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self._log, text=True)
        pattern = re.compile(r"http://[\w.\[\]:]+?:(\d+)/?(?:\?token=(\S+))?")
        seen = []
        for line in self.process.stdout:
            seen.append(line)
            match = pattern.search(line)
            if match:
                self.port = int(match.group(1))
                self.token = match.group(2)
                break
        else:
            raise RuntimeError(f"the server did not start: {''.join(seen)}\n{self.log()}")
        # Later output must not block it.
        threading.Thread(target=self.process.stdout.read, daemon=True).start()

    def log(self):
        return (self.folder / "server.log").read_text(errors="replace")[-4000:]

    # -- requests

    def connect(self, timeout_s=ANSWER_S):
        return socket.create_connection(("127.0.0.1", self.port), timeout=timeout_s)

    def headers(self, **more):
        headers = {"Host": f"127.0.0.1:{self.port}"}
        if self.token:
            headers["Authorization"] = f"Bearer {self.token}"
        headers.update({name.replace("_", "-"): value for name, value in more.items()})
        return headers

    def ask(self, method, path, body=None, headers=None, timeout_s=ANSWER_S):
        """One request on a new connection. A body that is not bytes is sent as JSON."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout_s)
        try:
            sent = self.headers() if headers is None else headers
            if body is not None and not isinstance(body, bytes):
                body = json.dumps(body).encode()
            if body is not None:
                sent = {"Content-Type": "application/json", **sent}
            connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
            for name, value in sent.items():
                connection.putheader(name, value)
            if body is not None:
                connection.putheader("Content-Length", str(len(body)))
            connection.endheaders(body)
            answer = connection.getresponse()
            return Answer(answer.status, dict(answer.getheaders()), answer.read())
        finally:
            connection.close()

    def get(self, path, **options):
        return self.ask("GET", f"/api/v1{path}", **options)

    def launch(self, scenario, overrides=None, **options):
        return self.ask("POST", "/api/v1/runs",
                        {"scenario": scenario, "overrides": overrides or {}}, **options)

    def ended(self, run_id, within_s=ANSWER_S):
        """Waits for the end of the run and returns it; raises after the time limit."""
        end = time.monotonic() + within_s
        while True:
            run = self.get(f"/runs/{run_id}").json()
            if run["status"] not in ("queued", "running"):
                return run
            if time.monotonic() > end:
                raise AssertionError(f"run {run_id} is {run['status']} after {within_s} s")
            time.sleep(0.05)

    # -- state

    def alive(self):
        return self.process.poll() is None

    def resident_mib(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status).group(1)) / 1024

    def sanitized(self):
        """True if the program was built with the address sanitizer, which needs much memory."""
        return "/libasan." in pathlib.Path(f"/proc/{self.process.pid}/maps").read_text()

    def stop(self):
        """Sends SIGTERM. Returns true if the server ended in time."""
        in_time = True
        if self.alive():
            self.process.send_signal(signal.SIGTERM)
            try:
                self.process.wait(STOP_S)
            except subprocess.TimeoutExpired:
                in_time = False
                self.process.kill()
                self.process.wait()
        self._log.close()
        if self._owns_folder:
            shutil.rmtree(self.folder, ignore_errors=True)
        return in_time
