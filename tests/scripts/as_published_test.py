#!/usr/bin/env python3
"""The paper's sweeps as published can be flown: `overfly sweep --dry-run` accepts them, with all their cells.

Usage: as_published_test.py OVERFLY SOURCE_FOLDER
"""
import pathlib
import subprocess
import sys
import tempfile

overfly, source = sys.argv[1], pathlib.Path(sys.argv[2])
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    subprocess.run([overfly, "world", "synthesize", "--texel-m", "5", "--size-m", "500", "--quiet",
                    "--out", str(folder / "world")], check=True, stdout=subprocess.DEVNULL)
    for sweep in ("paper_10", "paper_25"):
        document = subprocess.run(
            [sys.executable, str(source / "scripts/as_published.py"),
             str(source / f"scenarios/sweeps/{sweep}.json"), str(folder / "world/world.json")],
            check=True, capture_output=True, text=True).stdout
        (folder / "sweep.json").write_text(document)
        plan = subprocess.run([overfly, "sweep", str(folder / "sweep.json"), "--out", str(folder / sweep),
                               "--dry-run"], check=True, capture_output=True, text=True).stdout
        assert "24 cells, 3 estimators" in plan, plan
        assert '"throttle_hz": 20' in document and '"pacing": "real_time"' in document, document
        print(sweep, plan.strip())
