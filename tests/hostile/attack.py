"""What the attacks on the running server share.

The real program serves a small world on loopback. After every attack the server must still run and answer
at once. It must not have disclosed the secret that lies next to its data folders, and must not have
connected to any address: a listener on loopback takes the place of the network.
"""

import base64
import json
import os
import pathlib
import shutil
import sys
import unittest

from victim import SECRET, Listener, Victim

PROGRAM = None  # set by main()
HEALTH_S = 10
RESIDENT_LIMIT_MIB = 1500


def main(usage):
    """Runs the test cases of the calling script. The first argument is the program."""
    global PROGRAM
    if len(sys.argv) < 2:
        sys.exit(usage)
    PROGRAM = sys.argv.pop(1)
    unittest.main(verbosity=2)


class Attack(unittest.TestCase):
    """One server for each class. After each test the server must be running, responsive and discreet."""

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
        """Rejected at once or by the run itself. Returns the text of the error."""
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

    def assert_fields_work(self):
        """Flies with good values of the fields that are attacked, so that a refusal is one of the value."""
        for scenario, overrides in (("manifest", {"world.manifest": "world.json"}),
                                    ("listed", {"world.imagery.0.file": "ground.tif",
                                                "world.elevation": [{"file": "heights.tif"}]}),
                                    ("logged", {"flight.log.file": "flight.tum"})):
            self.assert_flies(scenario, overrides)

    def plant_run(self, name, **files):
        """Creates the folder of a finished run with some of its files replaced."""
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
            # 500: the operator's own file cannot be read.
            self.assertIn(answer.status, (200, 400, 404, 409, 422, 500), path)
            self.assertTrue(self.victim.alive(), path)
        self.assertEqual(self.victim.get("/runs").status, 200)


def handshake(victim, token="its own", host=None, origin=None, keep=False):
    """Requests the WebSocket. Returns the head of the response, or with `keep` the open socket."""
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


def vrt_of(file, relative):
    return ("<VRTDataset rasterXSize='256' rasterYSize='256'><SRS>EPSG:32610</SRS>"
            "<GeoTransform>600000, 4, 0, 4200000, 0, -4</GeoTransform>"
            "<VRTRasterBand dataType='Byte' band='1'><SimpleSource>"
            f"<SourceFilename relativeToVRT='{relative}'>{file}</SourceFilename>"
            "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>")
