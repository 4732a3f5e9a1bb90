#!/usr/bin/env python3
"""Attacks by damaged run folders.

Usage: run_folders_test.py PROGRAM [unittest options]
"""

import json
import pathlib
import shutil

import attack
from attack import Attack
from victim import SECRET


class RunFolders(Attack):
    """Files in the folder of the runs are as untrusted as requests."""

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


if __name__ == "__main__":
    attack.main(__doc__)
