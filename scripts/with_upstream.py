"""Prints a sweep with upstream ORB-SLAM2, DSO and SVO in the variants of the paper, as far as their adapters are there.

Usage: python3 scripts/with_upstream.py SWEEP ADAPTERS [--vocabulary FILE] [--variants | --alone SYSTEM]
    SWEEP       a sweep file; its estimators stay, and the systems with their default parameters join them
    ADAPTERS    folder of overfly-orbslam2, overfly-dso and overfly-svo (docs/ESTIMATORS.md, "Adapters")
    VOCABULARY  of ORB-SLAM2, if it is not in its sources
    --variants  the other variants of the paper, next to the sweep's baselines: one flight takes 8 estimators at most
    SYSTEM      orbslam2, dso or svo, next to the sweep's baselines only: in real time others would take its processors
"""
import argparse
import json
import pathlib
import sys

# Name and preset of each: first the one with the default parameters.
VARIANTS = {
    "orbslam2": [("orbslam2", "minThFAST_7"), ("orbslam2_fast_2", "minThFAST_2")],
    "dso": [("dso", "setting_minGradHistAdd_7"), ("dso_gradient_5", "setting_minGradHistAdd_5")],
    # 20 is the default of its code, 7 the one that the paper names.
    "svo": [("svo", "triangMinCornerScore_20"), ("svo_corner_7", "triangMinCornerScore_7"),
            ("svo_corner_2", "triangMinCornerScore_2"), ("svo_keyframe_5", "kfSelectMinDist_5")],
}
PROGRAMS = {system: f"overfly-{system}" for system in VARIANTS}
ORBSLAM2_FRAMES_PER_S = 20  # in the paper; the camera takes 31
PATIENCE_S = {"start_timeout_s": 120, "answer_timeout_s": 120}


def upstream_estimators(adapters, vocabulary, real_time):
    """Of the adapters that are in the folder; of each first the one with the default parameters."""
    estimators = []
    for system, variants in VARIANTS.items():
        program = adapters / PROGRAMS[system]
        if not program.is_file():
            continue
        for name, preset in variants:
            parameters = {"preset": preset}
            if system == "orbslam2" and vocabulary is not None:
                parameters["vocabulary"] = str(vocabulary.resolve())
            estimator = {"name": name, "type": "process", "command": [str(program.resolve())],
                         "parameters": parameters, **PATIENCE_S}
            if real_time and system == "orbslam2":
                estimator["throttle_hz"] = ORBSLAM2_FRAMES_PER_S
            estimators.append(estimator)
    return estimators


def with_upstream(sweep, folder, adapters, vocabulary, variants, alone):
    """Of a sweep's document in `folder`."""
    real_time = sweep.get("set", {}).get("pacing") == "real_time"
    upstream = upstream_estimators(adapters, vocabulary, real_time)
    if not upstream:
        sys.exit(f"{adapters}: has none of {', '.join(PROGRAMS.values())}")
    defaults = {system: own[0][0] for system, own in VARIANTS.items()}
    own = sweep["estimators"]
    if variants or alone:
        own = [estimator for estimator in own if estimator["type"].startswith("baseline_")]
    if variants:
        chosen = [estimator for estimator in upstream if estimator["name"] not in defaults.values()]
    else:
        wanted = [defaults[alone]] if alone else defaults.values()
        chosen = [estimator for estimator in upstream if estimator["name"] in wanted]
    if not chosen:
        sys.exit(f"{adapters / PROGRAMS[alone]}: is not there")
    return {**sweep, "title": sweep["title"] + ", upstream", "scenario": str((folder / sweep["scenario"]).resolve()),
            "estimators": own + chosen}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("sweep", type=pathlib.Path)
    parser.add_argument("adapters", type=pathlib.Path)
    parser.add_argument("--vocabulary", type=pathlib.Path)
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--variants", action="store_true")
    which.add_argument("--alone", choices=VARIANTS)
    given = parser.parse_args()
    print(json.dumps(with_upstream(json.loads(given.sweep.read_text()), given.sweep.parent, given.adapters,
                                   given.vocabulary, given.variants, given.alone), indent=2))
