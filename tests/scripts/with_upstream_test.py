#!/usr/bin/env python3
"""The paper's sweeps with upstream systems can be flown: `overfly sweep --dry-run` accepts them, and scripts/reproduce
flies and tables what a folder of adapters has.

Usage: with_upstream_test.py OVERFLY SOURCE_FOLDER
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

overfly, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])


def printed(sweep, adapters, *options, fails=False):
    run = subprocess.run([sys.executable, str(source / "scripts/with_upstream.py"), str(sweep), str(adapters),
                          *options], capture_output=True, text=True)
    assert (run.returncode != 0) == fails, run
    return run.stderr if fails else run.stdout


def planned(document, folder):
    (folder / "sweep.json").write_text(document)
    return subprocess.run([str(overfly), "sweep", str(folder / "sweep.json"), "--out", str(folder / "out"),
                           "--dry-run"], check=True, capture_output=True, text=True).stdout


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    adapters = folder / "adapters"
    adapters.mkdir()
    paper = source / "scenarios/sweeps/paper_25.json"
    assert "has none of overfly-orbslam2" in printed(paper, adapters, fails=True)
    for program in ("overfly-orbslam2", "overfly-dso", "overfly-svo"):
        (adapters / program).write_text("#!/bin/sh\nexit 1\n")
        (adapters / program).chmod(0o755)
    vocabulary = folder / "voc.txt"
    vocabulary.write_text("")
    whole = printed(paper, adapters, "--vocabulary", str(vocabulary))
    variants = printed(paper, adapters, "--variants", "--vocabulary", str(vocabulary))
    for document, count in ((whole, 7), (variants, 8)):
        plan = planned(document, folder)
        assert f"24 cells, {count} estimators" in plan, plan
        assert all("throttle_hz" not in entry for entry in json.loads(document)["estimators"])
    estimators = {entry["name"]: entry for document in (whole, variants)
                  for entry in json.loads(document)["estimators"]}
    assert len(estimators) == 12, estimators.keys()
    assert estimators["orbslam2_fast_2"]["parameters"] == {"preset": "minThFAST_2", "vocabulary": str(vocabulary)}
    assert estimators["svo_keyframe_5"]["parameters"] == {"preset": "kfSelectMinDist_5"}

    # In real time each system flies alone, ORB-SLAM2 with the frame rate of the paper.
    (folder / "fast.json").write_text(json.dumps({**json.loads(whole), "set": {"pacing": "real_time"}}))
    alone = json.loads(printed(folder / "fast.json", adapters, "--alone", "orbslam2"))["estimators"]
    assert [entry["name"] for entry in alone] == ["hold", "homography", "dead_reckoning", "orbslam2"], alone
    assert alone[-1]["throttle_hz"] == 20, alone
    assert "invalid choice" in printed(paper, adapters, "--alone", "vins", fails=True)

    # One cell through the script, with an adapter that cannot start: it is in the table, with its published errors.
    copy = folder / "copy"
    (copy / "build/release").mkdir(parents=True)
    (copy / "build/release/overfly").symlink_to(overfly)
    for part in ("scripts", "scenarios"):
        shutil.copytree(source / part, copy / part)
    sweep = json.loads(paper.read_text())
    sweep["set"].update({"duration_s": 1, "camera.width_px": 160, "camera.height_px": 120})
    sweep["axes"][1]["values"], sweep["axes"][2] = [45], {"path": "flight.course.height_agl_m", "values": [300]}
    (copy / "scenarios/sweeps/one.json").write_text(json.dumps(sweep))
    for program in ("overfly-dso", "overfly-svo"):
        (adapters / program).unlink()
    subprocess.run([str(copy / "scripts/reproduce"), str(folder / "tables"), "--adapters", str(adapters), "one"],
                   check=True, stdout=subprocess.DEVNULL)
    table = (folder / "tables/one.md").read_text()
    assert "orbslam2 position [m]" in table and "ORB-SLAM2, published" in table, table
    assert "orbslam2_fast_2" in (folder / "tables/one_variants.md").read_text()
    print("one cell with upstream systems is in its table")
