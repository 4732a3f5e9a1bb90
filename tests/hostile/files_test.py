#!/usr/bin/env python3
"""Attacks by file names and by files that refer to others.

Usage: files_test.py PROGRAM [unittest options]
"""

import json
import os
import pathlib
import re
import shutil
import time

import attack
from attack import HEALTH_S, Attack, vrt_of


def masked(text, place):
    """Replaces the place, as it was written or resolved, in `text`."""
    stem = pathlib.Path(place).name
    return re.sub(r"[\w./-]*" + re.escape(stem), "PLACE", text)


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

    def test_good_files_in_the_attacked_fields(self):
        self.assert_fields_work()

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
        # A file without a coordinate system, so that the scenario's is used.
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
                    answers_seen = []
                    for answer, place in zip(answers, (there, absent)):
                        self.assert_harmless(answer)
                        text = answer.text
                        if answer.status == 201:
                            run = self.victim.ended(answer.json()["id"])
                            text = f"{run['status']} {run['error']}"
                        answers_seen.append((answer.status, masked(text, place)))
                    self.assertEqual(answers_seen[0], answers_seen[1])

    def test_side_cars_of_a_raster_do_not_block_and_links_out_are_rejected(self):
        data = self.victim.data
        names = ("aux.xml", "ovr", "msk")
        mosaic = vrt_of("ground.tif", relative=1)
        for name in (*(f"neighbour.tif.{name}" for name in names), "neighbour.tfw", "neighbour.wld",
                     "neighbour.prj", "neighbour.tab", "neighbour.hdr", "neighbour.IMD"):
            for kind in ("fifo", "link to a file", "link to nothing"):
                with self.subTest(name=name, kind=kind):
                    shutil.copy(data / "ground.tif", data / "neighbour.tif")
                    (data / "neighbour.vrt").write_text(mosaic.replace("ground.tif", "neighbour.tif"))
                    side_car = data / name
                    if kind == "fifo":
                        os.mkfifo(side_car)
                        for file in ("neighbour.tif", "neighbour.vrt"):
                            run = self.assert_flies("listed", {"world.imagery.0.file": file})
                            log = self.victim.get(f"/runs/{run['id']}/manifest").text
                            self.assertIn(f"{name}: is not a regular file and is ignored", log)
                    else:
                        side_car.symlink_to(self.victim.outside / (
                            "secret.tif" if kind == "link to a file" else "absent.tif"))
                        for file in ("neighbour.tif", "neighbour.vrt"):
                            self.assert_refused("listed", {"world.imagery.0.file": file})
                        self.assert_refused("listed", {"world.elevation": [{"file": "neighbour.tif"}]})
                    side_car.unlink()

    def test_a_link_out_next_to_a_flight_log_is_rejected(self):
        times = self.victim.data / "times.txt"
        times.symlink_to(self.victim.outside / "secret.txt")
        self.assert_refused("logged", {})
        times.unlink()
        self.assert_flies("logged")

    def test_as_trajectory(self):
        """Every name but that of a trajectory in a data folder is answered alike."""
        outside = self.victim.outside
        (outside / "secret.tum").write_text("0 0 0 0 0 0 0 1\n")
        (self.victim.data / "good.tum").write_text("0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n")
        label = self.victim.data.name
        (self.victim.data / "out.tum").symlink_to(outside / "secret.tum")
        (self.victim.data / "nowhere.tum").symlink_to(outside / "absent.tum")
        os.mkfifo(self.victim.data / "fifo.tum")
        names = [f"file:{label}/{place}" for place in self.places()]
        names += [f"file:{label}/{name}.tum" for name in ("out", "nowhere", "fifo", "absent")]
        names += [f"{kind}:{place}" for kind in ("file", "log", "run", "x") for place in self.places()]
        names += [f"run:{place}/truth" for place in self.places()]
        for name in names:
            if "\0" in name or name == f"file:{label}/sparse.txt":  # a file of the folder
                continue
            with self.subTest(name=name[:60]):
                started = time.monotonic()
                answer = self.victim.ask("POST", "/api/v1/evaluations",
                                         {"truth": name, "estimates": [name]})
                self.assertEqual(answer.status, 404, answer.text[:300])
                self.assertIn("no such trajectory", answer.text)
                self.assert_harmless(answer)
                self.assertLess(time.monotonic() - started, HEALTH_S)
        good = f"file:{label}/good.tum"
        answer = self.victim.ask("POST", "/api/v1/evaluations", {"truth": good, "estimates": [good]})
        self.assertEqual(answer.status, 200, answer.text[:300])
        listed = [entry["name"] for entry in self.victim.get("/trajectories").json()["trajectories"]]
        self.assertTrue(any(name.endswith("data/good.tum") for name in listed), listed)
        for name in ("out", "nowhere", "fifo"):
            self.assertFalse(any(entry.endswith(f"/{name}.tum") for entry in listed), listed)

    def test_large_and_damaged_trajectories(self):
        data = self.victim.data
        label = data.name
        with open(data / "sparse.tum", "wb") as file:
            file.write(b"0 0 0 0 0 0 0 1\n")
            file.truncate(1 << 40)
        (data / "commas.csv").write_bytes(b"," * (32 << 20))
        (data / "lines.tum").write_bytes(b"".join(b"%d 0 0 0 0 0 0 1\n" % i for i in range(500_001)))
        (data / "cut.tum").write_text("0 0 0 0 0 0 0 1\n1 1 0 0")
        (data / "nan.tum").write_text("0 nan nan nan nan nan nan nan\n")
        (data / "huge.tum").write_text("0 1e308 1e308 0 0 0 0 1\n1 -1e308 0 0 0 0 0 1\n")
        for name, status in (("sparse.tum", 422), ("commas.csv", 422), ("lines.tum", 422),
                             ("cut.tum", 422), ("nan.tum", 422), ("huge.tum", 200)):
            with self.subTest(name=name):
                reference = f"file:{label}/{name}"
                answer = self.victim.ask("POST", "/api/v1/evaluations", {
                    "truth": reference, "estimates": [reference], "points": 100})
                self.assertEqual(answer.status, status, answer.text[:300])
                self.assertLess(len(answer.text), 100_000)

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


if __name__ == "__main__":
    attack.main(__doc__)
