#!/usr/bin/env python3
"""Attacks by large amounts: memory, connections, runs, servers.

Usage: amounts_test.py PROGRAM [unittest options]
"""

import concurrent.futures
import pathlib
import resource
import socket
import time

import attack
from attack import HEALTH_S, Attack, handshake
from victim import Victim


class Amounts(Attack):
    """Large images, little memory, many connections, many runs."""

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
        """Allocations and new threads fail: only what needs them may fail."""
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
                        continue  # The connection may be closed, but the server must run.
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
        """Many WebSockets or silent connections must not lock out other clients."""
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
        # Of the runs that never flew, only the last few are still listed.
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
        other = Victim(attack.PROGRAM, self.arguments, folder=self.victim.folder)
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


if __name__ == "__main__":
    attack.main(__doc__)
