#!/usr/bin/env python3
"""Attacks on the running server: a client must neither end, block, read nor redirect it.

Usage: hostile_test.py PROGRAM [unittest options]

The real program serves a small world on loopback. After every attack it must still be there, answer
at once, have told nobody the secret that lies beside its data folders, and have called nobody: a
listener on loopback stands for the rest of the world. New attacks are added here.
"""

import base64
import concurrent.futures
import json
import os
import pathlib
import re
import resource
import shutil
import socket
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from victim import SECRET, Listener, Victim

PROGRAM = None
HEALTH_S = 10
RESIDENT_LIMIT_MIB = 1500
DEEP = 80_000


def nested(depth, opened="[", closed="]"):
    return opened * depth + closed * depth


class Attack(unittest.TestCase):
    """One server for each class; what every attack must leave behind is checked after each."""

    arguments = ()

    @classmethod
    def setUpClass(cls):
        cls.listener = Listener()
        cls.victim = Victim(PROGRAM, cls.arguments)

    @classmethod
    def tearDownClass(cls):
        cls.victim.stop()
        cls.listener.close()

    def tearDown(self):
        if not self.victim.alive():
            log = self.victim.log()
            self.victim.stop()
            type(self).victim = Victim(PROGRAM, self.arguments)
            self.fail(f"the attack ended the server:\n{log[-1500:]}")
        health = self.victim.get("/health", timeout_s=HEALTH_S)
        self.assertEqual(health.status, 200, health.text)
        self.assertEqual(self.listener.calls, [], "the server called out")
        self.assertLess(self.victim.resident_mib(), RESIDENT_LIMIT_MIB)
        self.assertNotIn(SECRET, self.victim.log())
        del self.listener.calls[:]

    def assert_harmless(self, answer):
        self.assertNotIn(SECRET, answer.text)
        self.assertLess(answer.status, 500, answer.text[:500])

    def assert_refused(self, scenario, overrides):
        """Refused at once or by the run itself; the words of the refusal."""
        answer = self.victim.launch(scenario, overrides)
        self.assert_harmless(answer)
        if answer.status != 201:
            self.assertIn(answer.status, (400, 403, 404, 413, 422), answer.text[:500])
            return answer.text
        run = self.victim.ended(answer.json()["id"])
        text = json.dumps(run)
        self.assertEqual(run["status"], "failed", text[:500])
        self.assertNotIn(SECRET, text)
        return text

    def assert_flies(self, scenario, overrides=None):
        answer = self.victim.launch(scenario, overrides)
        self.assertEqual(answer.status, 201, answer.text[:500])
        run = self.victim.ended(answer.json()["id"])
        self.assertEqual(run["status"], "completed", json.dumps(run)[:800])
        return run

    def plant_run(self, name, **files):
        """A run folder as a finished flight leaves it, with some of its files replaced."""
        if not hasattr(type(self), "model"):
            type(self).model = self.assert_flies("listed")["id"]
        folder = self.victim.runs / name
        shutil.copytree(self.victim.runs / self.model, folder)
        for file, text in files.items():
            path = folder / f"{file}.json"
            path.unlink(missing_ok=True)
            if isinstance(text, pathlib.Path):
                path.symlink_to(text)
            else:
                path.write_text(text)
        return folder

    def assert_readable(self, run_id):
        for path in ("/runs", f"/runs/{run_id}", f"/runs/{run_id}/metrics",
                     f"/runs/{run_id}/manifest", f"/runs/{run_id}/estimators",
                     f"/runs/{run_id}/trajectories/truth?format=json",
                     f"/runs/{run_id}/frames/0.jpg"):
            answer = self.victim.get(path)
            self.assertNotIn(SECRET, answer.text)
            self.assertIn(answer.status, (200, 400, 404, 409, 500), path)
            self.assertTrue(self.victim.alive(), path)
        self.assertEqual(self.victim.get("/runs").status, 200)


class WithoutTheToken(Attack):
    ROUTES = ["/", "/index.html", "/assets/none.js", "/api/v1/health", "/api/v1/openapi.json",
              "/api/v1/scenarios", "/api/v1/scenarios/listed", "/api/v1/scenario-schema",
              "/api/v1/runs", "/api/v1/runs/x", "/api/v1/runs/x/metrics", "/api/v1/stream",
              "/no/such/page", "/../../etc/passwd"]

    def without(self, method, path, **headers):
        return self.victim.ask(method, path, headers={"Host": f"127.0.0.1:{self.victim.port}",
                                                      **headers})

    def test_every_route_is_closed(self):
        for path in self.ROUTES:
            for method in ("GET", "HEAD", "POST", "DELETE", "OPTIONS", "PUT", "BREW"):
                with self.subTest(method=method, path=path):
                    answer = self.without(method, path)
                    self.assertEqual(answer.status, 401)
                    self.assertNotIn("<title>page</title>", answer.text)

    def test_wrong_keys_open_nothing(self):
        token = self.victim.token
        self.assertTrue(token, "the server printed no token")
        self.assertGreaterEqual(len(token), 22, "shorter than 128 bit in base 64")
        wrong = ["", "x", token[:-1], token + "x", token.swapcase(), token[::-1], "\x00", "*" * 4000]
        for key in wrong:
            for headers in ({"Authorization": f"Bearer {key}"}, {"Authorization": key},
                            {"Authorization": f"Basic {key}"}, {"Cookie": f"token={key}"}):
                if "\x00" in key:
                    continue
                with self.subTest(key=key[:50], headers=list(headers)):
                    self.assertEqual(self.without("GET", "/api/v1/runs", **headers).status, 401)
            query = "".join(f"%{ord(c):02x}" for c in key)
            self.assertEqual(self.without("GET", f"/api/v1/runs?token={query}").status, 401)

    def test_upgrade_is_closed(self):
        answer = handshake(self.victim, token=None)
        self.assertIn(b" 401 ", answer.split(b"\r\n")[0])

    def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(self):
        answer = self.without("GET", f"/?token={self.victim.token}")
        cookie = answer.headers.get("Set-Cookie", "")
        self.assertIn("HttpOnly", cookie)
        self.assertIn("SameSite=Strict", cookie)
        pair = cookie.split(";")[0]
        self.assertEqual(self.without("GET", "/api/v1/runs", Cookie=pair).status, 200)

    def test_no_token_needs_loopback(self):
        done = subprocess.run([PROGRAM, "serve", "--port", "0", "--address", "0.0.0.0", "--no-token",
                               "--runs", str(self.victim.folder / "other_runs")],
                              capture_output=True, text=True, timeout=30, check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("token", done.stderr + done.stdout)


def handshake(victim, token="its own", host=None, origin=None, keep=False):
    """Asks for the WebSocket; the answer's head, or the open socket."""
    connection = victim.connect(20)
    lines = ["GET /api/v1/stream HTTP/1.1", f"Host: {host or f'127.0.0.1:{victim.port}'}",
             "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
             "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode()]
    if token == "its own":
        token = victim.token
    if token:
        lines.append(f"Authorization: Bearer {token}")
    if origin:
        lines.append(f"Origin: {origin}")
    connection.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
    head = b""
    try:
        while b"\r\n\r\n" not in head:
            part = connection.recv(4096)
            if not part:
                break
            head += part
    except OSError:
        pass
    if keep and b" 101 " in head.split(b"\r\n")[0]:
        return connection
    connection.close()
    return head


def text_frame(text):
    payload = text.encode()
    size = len(payload)
    head = bytes([0x81])
    if size < 126:
        head += bytes([0x80 | size])
    elif size < 65536:
        head += bytes([0x80 | 126]) + size.to_bytes(2, "big")
    else:
        head += bytes([0x80 | 127]) + size.to_bytes(8, "big")
    return head + b"\0\0\0\0" + payload


class Files(Attack):
    """What a scenario may name: regular files inside the data folders."""

    PLACES = ["/proc/self/mem", "/proc/kmsg", "/proc/self/environ", "/proc/self/maps", "/dev/zero",
              "/dev/stdin", "/dev/full", "/etc/passwd", "/etc/shadow", "/", "/proc", "fifo",
              "link_out.txt", "link_out.tif", "../../outside/secret.txt", "../../outside/secret.tif",
              "sparse.txt", "./../outside/secret.txt", ".", "", "ground.tif/x", "x" * 5000,
              "ground.tif\u0000.txt", "x" * 300, "loop", "loop/x.tif"]

    def places(self):
        return [*self.PLACES, str(self.victim.outside / "secret.txt"),
                str(self.victim.outside / "secret.tif")]

    def test_as_manifest(self):
        for place in self.places():
            with self.subTest(place=place[:60]):
                self.assert_refused("manifest", {"world.manifest": place})

    def test_as_imagery(self):
        for place in self.places():
            with self.subTest(place=place[:60]):
                self.assert_refused("listed", {"world.imagery.0.file": place})

    def test_as_elevation(self):
        for place in self.places():
            with self.subTest(place=place[:60]):
                self.assert_refused("listed", {"world.elevation": [{"file": place}]})

    def test_as_flight_log(self):
        for place in self.places():
            with self.subTest(place=place[:60]):
                self.assert_refused("logged", {"flight.log.file": place})

    def test_as_coordinate_system(self):
        # A file that names no system of its own, so that the scenario's is used.
        bare = self.victim.data / "bare.tif"
        if not bare.exists():
            shutil.copy(self.victim.data / "ground.tif", bare)
            data = bytearray(bare.read_bytes())
            data[8:10] = (11).to_bytes(2, "little")  # without its last tag, the GeoKeys
            bare.write_bytes(bytes(data))
        self.assert_flies("listed", {"world.imagery": [{"file": "bare.tif", "crs": "EPSG:32610"}]})
        for place in [*self.places(), "@/etc/passwd", "+init=/etc/passwd:1", "ESRI::/etc/passwd",
                      "+proj=utm +zone=10 +nadgrids=/etc/passwd", "IMPORT_FROM_WKT_FILE:/etc/passwd",
                      "+proj=utm +zone=10 +geoidgrids=/proc/kmsg",
                      "+proj=utm +zone=10 +nadgrids=@../../outside/secret.tif"]:
            for file in ("bare.tif", "ground.tif"):
                with self.subTest(place=place[:60], file=file):
                    words = self.assert_refused(
                        "listed", {"world.imagery": [{"file": file, "crs": place}]})
                    self.assertNotIn("root:", words)

    def test_the_data_folder_is_not_the_clients_to_choose(self):
        for folder in ("/", "/etc", str(self.victim.outside), "../outside", "../..", "data/../.."):
            for overrides in ({"data": folder, "world.imagery.0.file": "secret.tif"},
                              {"data": folder, "world.imagery.0.file": "outside/secret.tif"},
                              {"data": folder, "flight": {"log": {"file": "passwd"}}}):
                with self.subTest(folder=folder, overrides=overrides):
                    self.assert_refused("listed", overrides)

    def test_virtual_file_systems_and_drivers(self):
        ground = self.victim.data / "ground.tif"
        secret = self.victim.outside / "secret.tif"
        vrt = vrt_of(secret, relative=0)
        for name in (f"/vsizip/{secret}", f"/vsigzip/{secret}", f"/vsitar/{secret}", "/vsistdin/",
                     f"/vsisubfile/0_100,{secret}", f"/vsisparse/{secret}", f"/vsicrypt/{secret}",
                     f"/vsicached?file={secret}", f"GTIFF_DIR:1:{secret}", f"GTIFF_DIR:1:{ground}",
                     f"GTIFF_RAW:{secret}", f"vrt://{secret}", f"NETCDF:{secret}:x", vrt,
                     f"DERIVED_SUBDATASET:LOGAMPLITUDE:{secret}", f"file://{secret}", "PG:host=127.0.0.1",
                     f"MEM:::DATAPOINTER=140000000,PIXELS=8,LINES=8", "/vsimem/x.tif",
                     json.dumps({"type": "Feature"}), f"PLSCENES:{secret}", f"HDF5:\"{secret}\"://x"):
            for field in ("imagery", "elevation"):
                with self.subTest(name=name[:60], field=field):
                    layers = [{"file": name}]
                    overrides = {f"world.{field}": layers}
                    self.assert_refused("listed", overrides)

    def test_what_a_client_wrote_is_no_imagery(self):
        secret = self.victim.outside / "secret.tif"
        for field in ("$schema", "title", "description", "name"):
            with self.subTest(field=field):
                planted = self.victim.launch("listed", {field: vrt_of(secret, relative=0)})
                self.assert_harmless(planted)
                if planted.status != 201:
                    continue
                run = self.victim.ended(planted.json()["id"])
                for name in ("scenario.json", "manifest.json"):
                    file = self.victim.runs / run["id"] / name
                    for place in (str(file), f"../../runs/{run['id']}/{name}"):
                        self.assert_refused("listed", {"world.imagery.0.file": place})

    def test_mosaics_reach_no_further_than_their_folder(self):
        data = self.victim.data
        secret = self.victim.outside / "secret.tif"
        (data / "inner.vrt").write_text(vrt_of("ground.tif", relative=1))
        self.assert_flies("listed", {"world.imagery.0.file": "inner.vrt"})
        url = f"/vsicurl/http://127.0.0.1:{self.listener.port}/x.tif"
        evil = {
            "absolute": vrt_of(secret, relative=0),
            "upwards": vrt_of("../../outside/secret.tif", relative=1),
            "link": vrt_of("link_out.tif", relative=1),
            "network": vrt_of(url, relative=0),
            "network_as_relative": vrt_of(url, relative=1),
            "nested": vrt_of("absolute.vrt", relative=1),
            "itself": vrt_of("itself.vrt", relative=1),
            "fifo": vrt_of("fifo", relative=1),
            "service": f"<GDAL_WMS><Service name='WMS'><ServerUrl>http://127.0.0.1:"
                       f"{self.listener.port}/?</ServerUrl><Layers>x</Layers></Service>"
                       "<DataWindow><UpperLeftX>0</UpperLeftX><UpperLeftY>0</UpperLeftY>"
                       "<LowerRightX>1</LowerRightX><LowerRightY>-1</LowerRightY><SizeX>64</SizeX>"
                       "<SizeY>64</SizeY></DataWindow><BandsCount>1</BandsCount></GDAL_WMS>",
        }
        for name, text in evil.items():
            (data / f"{name}.vrt").write_text(text)
            (data / f"{name}.json").write_text(json.dumps({
                "format_version": 1, "imagery": [{"file": f"{name}.vrt"}], "ground_height_m": 100}))
        for name in evil:
            for ending in ("vrt", "json"):
                with self.subTest(name=name, ending=ending):
                    if ending == "vrt":
                        self.assert_refused("listed", {"world.imagery.0.file": f"{name}.vrt"})
                    else:
                        self.assert_refused("manifest", {"world.manifest": f"{name}.json"})

    def test_a_manifest_reaches_no_further_than_a_scenario(self):
        data = self.victim.data
        for number, place in enumerate(self.places()):
            for layer in ({"file": place}, {"file": "ground.tif", "crs": place}):
                name = f"evil_{number}.json"
                (data / name).write_text(json.dumps({
                    "format_version": 1, "imagery": [layer], "ground_height_m": 100}))
                with self.subTest(layer=str(layer)[:80]):
                    self.assert_refused("manifest", {"world.manifest": name})

    def test_existing_and_missing_files_look_the_same(self):
        outside = self.victim.outside
        pairs = [(str(outside / "secret.tif"), str(outside / "absent.tif")),
                 (str(outside / "secret.txt"), str(outside / "absent.txt")),
                 ("/etc/passwd", "/etc/passwx"), ("/etc", "/etx"), ("/root", "/roox"),
                 ("../../outside/secret.tif", "../../outside/absent.tif")]
        fields = [("manifest", "world.manifest"), ("listed", "world.imagery.0.file"),
                  ("logged", "flight.log.file"), ("listed", "world.imagery.0.crs")]
        for there, absent in pairs:
            for scenario, field in fields:
                with self.subTest(field=field, there=there):
                    answers = [self.victim.launch(scenario, {field: place})
                               for place in (there, absent)]
                    told = []
                    for answer, place in zip(answers, (there, absent)):
                        self.assert_harmless(answer)
                        text = answer.text
                        if answer.status == 201:
                            run = self.victim.ended(answer.json()["id"])
                            text = f"{run['status']} {run['error']}"
                        told.append((answer.status, masked(text, place)))
                    self.assertEqual(told[0], told[1])

    def test_files_beside_a_raster_are_neither_waited_for_nor_followed_out(self):
        data = self.victim.data
        names = ("aux.xml", "ovr", "msk")
        mosaic = vrt_of("ground.tif", relative=1)
        for name in (*(f"beside.tif.{name}" for name in names), "beside.tfw", "beside.wld",
                     "beside.prj", "beside.tab", "beside.hdr", "beside.IMD"):
            for kind in ("fifo", "link to a file", "link to nothing"):
                with self.subTest(name=name, kind=kind):
                    shutil.copy(data / "ground.tif", data / "beside.tif")
                    (data / "beside.vrt").write_text(mosaic.replace("ground.tif", "beside.tif"))
                    side_car = data / name
                    if kind == "fifo":
                        os.mkfifo(side_car)
                        for file in ("beside.tif", "beside.vrt"):
                            run = self.assert_flies("listed", {"world.imagery.0.file": file})
                            log = self.victim.get(f"/runs/{run['id']}/manifest").text
                            self.assertIn(f"{name}: is not a regular file and is ignored", log)
                    else:
                        side_car.symlink_to(self.victim.outside / (
                            "secret.tif" if kind == "link to a file" else "absent.tif"))
                        for file in ("beside.tif", "beside.vrt"):
                            self.assert_refused("listed", {"world.imagery.0.file": file})
                        self.assert_refused("listed", {"world.elevation": [{"file": "beside.tif"}]})
                    side_car.unlink()

    def test_times_beside_a_flight_are_not_followed_out(self):
        times = self.victim.data / "times.txt"
        times.symlink_to(self.victim.outside / "secret.txt")
        self.assert_refused("logged", {})
        times.unlink()
        self.assert_flies("logged")

    def test_opening_a_large_file_is_cancelled(self):
        answer = self.victim.launch("listed", {"world.imagery.0.file": "endless.tif"})
        self.assertEqual(answer.status, 201, answer.text[:300])
        run_id = answer.json()["id"]
        time.sleep(1)
        self.assertEqual(self.victim.get(f"/runs/{run_id}").json()["status"], "running")
        self.victim.ask("POST", f"/api/v1/runs/{run_id}/cancel")
        self.assertEqual(self.victim.ended(run_id, HEALTH_S)["status"], "cancelled")
        self.assert_flies("listed")

    def test_blocked_files_do_not_block_the_queue(self):
        for scenario, field, place in (("logged", "flight.log.file", "/proc/kmsg"),
                                       ("logged", "flight.log.file", "fifo"),
                                       ("listed", "world.imagery.0.crs", "fifo"),
                                       ("listed", "world.imagery.0.file", "fifo"),
                                       ("manifest", "world.manifest", "fifo")):
            with self.subTest(field=field, place=place):
                answer = self.victim.launch(scenario, {field: place})
                self.assert_harmless(answer)
                if answer.status == 201:
                    run_id = answer.json()["id"]
                    self.victim.ask("POST", f"/api/v1/runs/{run_id}/cancel")
                    self.victim.ended(run_id)
                self.assert_flies("listed")


def masked(text, place):
    """`text` without the place as it was written or as it resolves to."""
    stem = pathlib.Path(place).name
    return re.sub(r"[\w./-]*" + re.escape(stem), "PLACE", text)


def vrt_of(file, relative):
    return ("<VRTDataset rasterXSize='256' rasterYSize='256'><SRS>EPSG:32610</SRS>"
            "<GeoTransform>600000, 4, 0, 4200000, 0, -4</GeoTransform>"
            "<VRTRasterBand dataType='Byte' band='1'><SimpleSource>"
            f"<SourceFilename relativeToVRT='{relative}'>{file}</SourceFilename>"
            "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>")


class Calls(Attack):
    """The server calls nobody, whatever field an address stands in."""

    def addresses(self):
        host = f"127.0.0.1:{self.listener.port}"
        return [f"http://{host}/x.tif", f"/vsicurl/http://{host}/x.tif", f"/vsis3/{host}/x",
                f"/vsicurl_streaming/http://{host}/x.tif", f"/vsizip//vsicurl/http://{host}/x.zip/x",
                f"/vsicurl?url=http%3A%2F%2F{host}%2Fx.tif", f"/vsiwebhdfs/http://{host}/x",
                f"WMS:http://{host}/?SERVICE=WMS", f"WMTS:http://{host}/", f"WCS:http://{host}/",
                f"EEDAI:http://{host}", f"OGCAPI:http://{host}/", f"STACTA:http://{host}/x.json",
                f"ZARR:\"/vsicurl/http://{host}/\"", f"DAAS:http://{host}/", f"PLMOSAIC:base_url=http://{host}",
                f"<GDAL_WMS><Service name='TMS'><ServerUrl>http://{host}/${{z}}</ServerUrl></Service></GDAL_WMS>",
                f"<WCS_GDAL><ServiceURL>http://{host}/</ServiceURL></WCS_GDAL>", f"ftp://{host}/x",
                f"//{host}/share/x.tif", f"vrt:///vsicurl/http://{host}/x.tif"]

    def test_no_field_is_fetched(self):
        fields = [("listed", "world.imagery.0.crs"), ("listed", "world.imagery.0.file"),
                  ("listed", "world.elevation"), ("manifest", "world.manifest"),
                  ("logged", "flight.log.file"), ("listed", "data")]
        for address in self.addresses():
            for scenario, field in fields:
                with self.subTest(field=field, address=address[:60]):
                    value = [{"file": address}] if field == "world.elevation" else address
                    self.assert_refused(scenario, {field: value})
                    self.assertEqual(self.listener.calls, [])

    def test_no_estimator_is_reached(self):
        host = f"127.0.0.1:{self.listener.port}"
        for estimator in ({"type": "process", "command": ["/bin/sh", "-c", f"echo {SECRET}"]},
                          {"type": "process", "listen": f"tcp:{host}"},
                          {"type": "process", "listen": "unix:/tmp/overfly-hostile.sock"},
                          {"type": "ros1", "ros1": {"master_uri": f"http://{host}"}},
                          {"type": "lcm", "lcm": {"url": "udpm://239.255.76.67:7667?ttl=1"}}):
            with self.subTest(estimator=str(estimator)[:60]):
                answer = self.victim.launch("listed", {"estimators": [{"name": "e", **estimator}]})
                self.assertIn(answer.status, (400, 403), answer.text[:300])


class Names(Attack):
    """Web pages of other sites, by other names for this machine."""

    def test_loopback_answers_to_its_own_names_only(self):
        check_names(self)


class NamesOnAllAddresses(Attack):
    arguments = ("--address", "0.0.0.0")

    def test_all_addresses_answer_to_their_own_names_only(self):
        check_names(self)


def check_names(test):
    victim = test.victim
    port = victim.port
    good = [f"127.0.0.1:{port}", f"localhost:{port}"]
    evil = ["evil.example", f"evil.example:{port}", "127.0.0.1.evil.example", f"localhost.evil:{port}",
            "", "10.1.2.3", "[::2]", "127.0.0.1@evil.example", "evil.example#127.0.0.1", "x" * 3000]
    for host in good:
        test.assertEqual(victim.get("/runs", headers=victim.headers(Host=host)).status, 200, host)
        test.assertIn(b" 101 ", handshake(victim, host=host).split(b"\r\n")[0])
    for host in evil:
        with test.subTest(host=host[:40]):
            for method, path in (("GET", "/api/v1/runs"), ("POST", "/api/v1/runs"), ("GET", "/")):
                answer = victim.ask(method, path, headers=victim.headers(Host=host))
                test.assertIn(answer.status, (400, 403, 421), f"{method} {path}")
            if host:
                test.assertNotIn(b" 101 ", handshake(victim, host=host).split(b"\r\n")[0])
    for origin in ("http://evil.example", f"http://evil.example:{port}", "null", "file://",
                   f"http://localhost.evil.example:{port}", "http://"):
        with test.subTest(origin=origin):
            answer = victim.ask("POST", "/api/v1/runs", {"scenario": "listed"},
                                headers=victim.headers(Origin=origin))
            test.assertEqual(answer.status, 403, answer.text[:200])
            test.assertIn(b" 403 ", handshake(victim, origin=origin).split(b"\r\n")[0])


class Depth(Attack):
    """JSON and paths without end."""

    def post(self, body):
        answer = self.victim.ask("POST", "/api/v1/runs", body)
        self.assert_harmless(answer)
        self.assertIn(answer.status, (400, 413), answer.text[:200])

    def test_bodies(self):
        for value in (nested(DEEP), nested(DEEP, '{"a":', "}").replace("{}", "1"), "[" * DEEP,
                      '{"a":' * DEEP, nested(70)):
            with self.subTest(value=value[:20]):
                self.post(('{"scenario":"listed","overrides":{"estimators":' + value + "}}").encode())
                self.post(('{"scenario":' + value + "}").encode())
                self.post(value.encode())

    def test_dotted_paths(self):
        for part in ("a", "0", "world", ""):
            for parts in (100_000, 70):
                with self.subTest(part=part, parts=parts):
                    self.post({"scenario": "listed", "overrides": {".".join([part] * parts): 1}})

    def test_stream_messages(self):
        connection = handshake(self.victim, keep=True)
        self.assertIsInstance(connection, socket.socket)
        with connection:
            for text in (nested(20_000), '{"type":"attach","run":' + nested(20_000) + "}",
                         '{"a":' * 10_000, "null", "[]", "{", '{"type":null}'):
                connection.sendall(text_frame(text))
            connection.settimeout(HEALTH_S)
            self.assertTrue(connection.recv(10))

    def test_files_of_a_run(self):
        deep = nested(DEEP)
        for file in ("manifest", "metrics", "scenario", "timings"):
            for number, text in enumerate((deep, '{"a":' + deep + "}", "[" * DEEP, '{"a":' * DEEP)):
                with self.subTest(file=file, number=number):
                    folder = self.plant_run(f"deep_{file}_{number}", **{file: text})
                    self.assert_readable(folder.name)

    def test_scenario_files(self):
        for number, text in enumerate((nested(DEEP), '{"a":' * DEEP, '{"world":' + nested(DEEP) + "}")):
            (self.victim.scenarios / f"deep_{number}.json").write_text(text)
        listed = self.victim.get("/scenarios")
        self.assertEqual(listed.status, 200)
        names = {entry["name"]: entry for entry in listed.json()["scenarios"]}
        self.assertIsNone(names["listed"]["error"])
        for number in range(3):
            self.assertTrue(names[f"deep_{number}"]["error"])
            # The file is the operator's, so the fault is the server's side: 500 with its reason.
            for answer in (self.victim.get(f"/scenarios/deep_{number}"),
                           self.victim.launch(f"deep_{number}")):
                self.assertGreaterEqual(answer.status, 400)
                self.assertIn("error", answer.json())

    def test_manifest_of_a_world(self):
        (self.victim.data / "deep.json").write_text('{"imagery":' + nested(DEEP) + "}")
        self.assert_refused("manifest", {"world.manifest": "deep.json"})


class RunFolders(Attack):
    """What lies in the folder of the runs is as untrusted as a request."""

    def test_files_that_cannot_be_read(self):
        for file in ("manifest", "metrics", "scenario", "timings"):
            for number, place in enumerate(("/proc/self/mem", "/proc/kmsg", "/dev/zero",
                                            self.victim.data / "fifo", self.victim.data / "sparse.txt",
                                            self.victim.outside / "secret.txt", "/")):
                with self.subTest(file=file, place=str(place)):
                    folder = self.plant_run(f"odd_{file}_{number}", **{file: pathlib.Path(place)})
                    self.assert_readable(folder.name)

    def test_links_out_of_the_folder(self):
        folder = self.plant_run("linked")
        for name in ("truth.tum", "estimates/perfect.tum", "manifest.json", "log.jsonl"):
            (folder / name).unlink(missing_ok=True)
            (folder / name).symlink_to(self.victim.outside / "secret.txt")
        for path in ("trajectories/truth", "trajectories/perfect", "manifest", "frames/0.jpg"):
            with self.subTest(path=path):
                answer = self.victim.get(f"/runs/{folder.name}/{path}")
                self.assertNotIn(SECRET, answer.text)

    def test_wrong_types_everywhere(self):
        self.plant_run("model_again")
        for file in ("manifest", "metrics", "timings", "scenario"):
            path = self.victim.runs / self.model / f"{file}.json"
            if not path.exists():
                continue
            document = json.loads(path.read_text())
            for key in document:
                for number, value in enumerate((None, -1e308, "\x00", [], {}, True)):
                    with self.subTest(file=file, key=key, value=value):
                        changed = json.dumps({**document, key: value})
                        folder = self.plant_run(f"typed_{file}_{key}_{number}", **{file: changed})
                        self.assertEqual(self.victim.get(f"/runs/{folder.name}").status, 200)
                        shutil.rmtree(folder)
        self.assertEqual(self.victim.get("/runs").status, 200)


class Amounts(Attack):
    """Too much of everything."""

    arguments = ("--memory-limit", "1024")

    def test_cameras_larger_than_the_memory(self):
        cameras = [{"name": f"c{i}", "width_px": 8192, "height_px": 8192, "color": "rgb"}
                   for i in range(8)]
        document = {"format_version": 1, "data": "data", "cameras": cameras, "duration_s": 1,
                    "world": {"imagery": [{"file": "ground.tif"}], "ground_height_m": 100},
                    "flight": {"course": {}}, "estimators": []}
        self.victim.write_scenario("huge", document)
        before = self.victim.resident_mib()
        answer = self.victim.launch("huge")
        self.assertIn(answer.status, range(400, 500), answer.text[:300])
        self.assertIn("memory", answer.text)
        self.assertLess(self.victim.resident_mib() - before, 200)

    def test_memory_that_ends(self):
        """Neither an allocation nor a thread can be had: what asked for it fails, nothing else."""
        if self.victim.sanitized():
            self.skipTest("the address sanitizer ends the program when memory ends")
        pid = self.victim.process.pid
        used = int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[0]) * resource.getpagesize()
        before = resource.prlimit(pid, resource.RLIMIT_AS)
        try:
            for spare_mib in (1, 30, 150, 400):
                resource.prlimit(pid, resource.RLIMIT_AS, (used + (spare_mib << 20), before[1]))
                for scenario, overrides in (("listed", {}), ("logged", {}),
                                            ("listed", {"camera.width_px": 4096,
                                                        "camera.height_px": 4096})):
                    try:
                        answer = self.victim.launch(scenario, overrides, timeout_s=20)
                    except OSError:
                        continue  # A connection may be closed; the server may not.
                    finally:
                        self.assertTrue(self.victim.alive(), f"{spare_mib} MiB to spare")
                    if answer.status == 201:
                        self.ended_somehow(answer.json()["id"])
        finally:
            resource.prlimit(pid, resource.RLIMIT_AS, before)
        self.assert_flies("listed")
        states = {run["status"] for run in self.victim.get("/runs").json()["runs"]}
        self.assertFalse(states & {"running", "queued"}, states)

    def ended_somehow(self, run_id):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            self.assertTrue(self.victim.alive())
            try:
                if self.victim.get(f"/runs/{run_id}", timeout_s=5).json()["status"] not in (
                        "queued", "running"):
                    return
            except (OSError, ValueError, KeyError):
                pass
            time.sleep(0.2)
        self.fail(f"run {run_id} never ended")

    def test_open_sockets(self):
        """Neither WebSockets nor silent connections lock anybody out."""
        held = []
        try:
            for _ in range(400):
                kept = handshake(self.victim, keep=True)
                if isinstance(kept, socket.socket):
                    held.append(kept)
                elif held:
                    break
            self.assertGreater(len(held), 0)
            self.assertEqual(self.victim.get("/runs", timeout_s=HEALTH_S).status, 200)
            for _ in range(600):
                try:
                    held.append(self.victim.connect(5))
                except OSError:
                    break
            self.assertEqual(self.victim.get("/runs", timeout_s=2 * HEALTH_S).status, 200)
        finally:
            for connection in held:
                connection.close()

    def test_a_queue_without_end(self):
        slow = {"duration_s": 600, "camera.width_px": 640, "camera.height_px": 480}
        first = self.victim.launch("listed", slow)
        self.assertEqual(first.status, 201, first.text[:300])
        ids = [first.json()["id"]]
        statuses = []
        for _ in range(400):
            answer = self.victim.launch("listed", slow)
            statuses.append(answer.status)
            if answer.status != 201:
                break
            ids.append(answer.json()["id"])
        self.assertIn(statuses[-1], (409, 429, 503), "400 runs wait")
        for run_id in reversed(ids):
            cancelled = self.victim.ask("POST", f"/api/v1/runs/{run_id}/cancel")
            self.assertEqual(cancelled.status, 202, cancelled.text[:300])
        # Of those that never flew only the last few are listed still.
        self.assertEqual(self.victim.ended(ids[0])["status"], "cancelled")
        runs = self.victim.get("/runs").json()["runs"]
        self.assertFalse([run["id"] for run in runs if run["status"] in ("queued", "running")])
        self.assert_flies("listed")

    def test_one_run_deleted_by_six(self):
        for _ in range(5):
            run_id = self.assert_flies("listed")["id"]
            with concurrent.futures.ThreadPoolExecutor(6) as crowd:
                answers = list(crowd.map(
                    lambda _: self.victim.ask("DELETE", f"/api/v1/runs/{run_id}").status, range(6)))
            self.assertEqual(answers.count(204), 1, answers)
            self.assertTrue(set(answers) <= {204, 404, 409}, answers)

    def test_two_servers_on_one_folder(self):
        other = Victim(PROGRAM, self.arguments, folder=self.victim.folder)
        try:
            with concurrent.futures.ThreadPoolExecutor(4) as crowd:
                answers = list(crowd.map(
                    lambda k: (self.victim, other)[k % 2].launch("listed"), range(16)))
            for answer in answers:
                self.assertEqual(answer.status, 201, answer.text[:300])
            ids = [answer.json()["id"] for answer in answers]
            self.assertEqual(len(set(ids)), len(ids))
            for k, run_id in enumerate(ids):
                self.assertEqual((self.victim, other)[k % 2].ended(run_id)["status"], "completed")
        finally:
            other.stop()


class Ends(unittest.TestCase):
    def test_sigterm_ends_a_server_that_opens_a_world_for_a_viewer(self):
        flown = Victim(PROGRAM)
        self.addCleanup(flown.stop)
        run = flown.ended(flown.launch("listed").json()["id"])
        self.assertEqual(run["status"], "completed")
        (flown.data / "endless.tif").replace(flown.data / "ground.tif")
        # Another server on the same folders: the one that flew it may have the world open still.
        victim = Victim(PROGRAM, folder=flown.folder)
        with concurrent.futures.ThreadPoolExecutor(1) as viewer:
            # The recorded pictures are drawn anew, over the file as it is now.
            asked = viewer.submit(victim.get, f"/runs/{run['id']}/frames/0.jpg")
            time.sleep(1)
            self.assertFalse(asked.done())
            self.assertTrue(victim.stop(), "SIGTERM did not end it")
            self.assertEqual(victim.process.returncode, 0)
            self.assertIsNotNone(asked.exception())

    def test_sigterm_ends_a_server_whose_runs_hang(self):
        for field, scenario, place in (("flight.log.file", "logged", "/proc/kmsg"),
                                       ("flight.log.file", "logged", "fifo"),
                                       ("world.imagery.0.crs", "listed", "fifo"),
                                       ("world.imagery.0.file", "listed", "fifo"),
                                       ("world.imagery.0.file", "listed", "endless.tif")):
            with self.subTest(field=field, place=place):
                victim = Victim(PROGRAM)
                victim.launch(scenario, {field: place})
                time.sleep(0.5)
                self.assertTrue(victim.stop(), "SIGTERM did not end it")
                self.assertEqual(victim.process.returncode, 0)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    PROGRAM = sys.argv.pop(1)
    unittest.main(verbosity=2)
