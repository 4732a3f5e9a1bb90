#!/usr/bin/env python3
"""Attacks by deeply nested JSON.

Usage: depth_test.py PROGRAM [unittest options]
"""

import socket

import attack
from attack import HEALTH_S, Attack, handshake, text_frame


DEEP = 80_000


def nested(depth, opened="[", closed="]"):
    return opened * depth + closed * depth


class Depth(Attack):
    """JSON that is nested too deep, and paths that are too long."""

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
            for text in (nested(20_000), '{"type":"watch","run":' + nested(20_000) + "}",
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
            # The file belongs to the operator, so a 500 with the reason is allowed too.
            for answer in (self.victim.get(f"/scenarios/deep_{number}"),
                           self.victim.launch(f"deep_{number}")):
                self.assertGreaterEqual(answer.status, 400)
                self.assertIn("error", answer.json())

    def test_manifest_of_a_world(self):
        self.assert_flies("manifest")
        (self.victim.data / "deep.json").write_text('{"imagery":' + nested(DEEP) + "}")
        self.assert_refused("manifest", {"world.manifest": "deep.json"})


if __name__ == "__main__":
    attack.main(__doc__)
