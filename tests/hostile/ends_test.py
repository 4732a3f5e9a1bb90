#!/usr/bin/env python3
"""SIGTERM must end a server that is busy or blocked.

Usage: ends_test.py PROGRAM [unittest options]
"""

import concurrent.futures
import time
import unittest

import attack
from victim import Victim


class Ends(unittest.TestCase):
    def test_sigterm_ends_a_server_that_opens_a_world_for_a_viewer(self):
        flown = Victim(attack.PROGRAM)
        self.addCleanup(flown.stop)
        run = flown.ended(flown.launch("listed").json()["id"])
        self.assertEqual(run["status"], "completed")
        (flown.data / "endless.tif").replace(flown.data / "ground.tif")
        # Another server on the same folders, because the first may still have the world open.
        victim = Victim(attack.PROGRAM, folder=flown.folder)
        with concurrent.futures.ThreadPoolExecutor(1) as viewer:
            # The recorded pictures are drawn again, with the replaced file.
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
                victim = Victim(attack.PROGRAM)
                victim.launch(scenario, {field: place})
                time.sleep(0.5)
                self.assertTrue(victim.stop(), "SIGTERM did not end it")
                self.assertEqual(victim.process.returncode, 0)


if __name__ == "__main__":
    attack.main(__doc__)
