"""Prints the sweep that flies the cells of another one as the paper seems to have flown them: in real time, the
estimator at 20 frames per second, over imagery of 1 m per pixel.

Usage: python3 scripts/as_published.py SWEEP WORLD
    SWEEP  one of scenarios/sweeps
    WORLD  manifest of the world
"""
import json
import pathlib
import sys

FRAMES_PER_S = 20  # of ORB-SLAM2 in the paper; the camera takes 31


def as_published(sweep, folder, world):
    """Of a sweep's document in `folder`."""
    estimator = {"name": "feature", "type": "feature", "throttle_hz": FRAMES_PER_S}
    # The baselines' time would be taken from the estimator's; these two need none.
    idle = [{"name": name, "type": "baseline_" + name} for name in ("hold", "dead_reckoning")]
    return {
        **sweep,
        "title": sweep["title"] + ", as published",
        "description": "In real time over imagery of 1 m per pixel; "
                       f"feature and ORB-SLAM2 at {FRAMES_PER_S} frames per second.",
        "scenario": str((folder / sweep["scenario"]).resolve()),
        "set": {**sweep.get("set", {}), "pacing": "real_time", "world": {"manifest": str(world.resolve())}},
        "estimators": [estimator, *idle],
    }


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    path = pathlib.Path(sys.argv[1])
    print(json.dumps(as_published(json.loads(path.read_text()), path.parent, pathlib.Path(sys.argv[2])), indent=2))
