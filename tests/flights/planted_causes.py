#!/usr/bin/env python3
"""Checks that `overfly explain` names the causes that were planted in flights, and none in flights
that succeed.

Usage: planted_causes.py BINARY RESULTS_FOLDER [--list FILE] [--only NAME,...] [--flights N] [--table]

Flies each entry of planted_causes.json: the base scenario with a few fields changed. An entry with a
`cause` must fail, and `explain` must name this cause alone, as necessary or sufficient. An entry
without one must succeed, and `explain` must name nothing. The result of each entry is written to
RESULTS_FOLDER/NAME.json; entries that have a result are skipped. --table only prints the results.
Exit code 0 = every planted flight failed and every other one succeeded, at least 18 of 20 planted
causes were named correctly, and none in a flight that succeeded.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import time

LEAST_SHARE_NAMED = 0.9


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--list", type=pathlib.Path,
                        default=pathlib.Path(__file__).with_name("planted_causes.json"))
    parser.add_argument("--only", type=lambda text: text.split(","), default=[])
    parser.add_argument("--flights", type=int, default=12)
    parser.add_argument("--table", action="store_true")
    return parser.parse_args()


def called(command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{command[1]} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def explained(args, scenario, entry):
    """The outcome of the entry's flight, and what explain answers about it."""
    run = args.results / "runs" / entry["name"]
    shutil.rmtree(run, ignore_errors=True)
    command = [args.binary, "run", scenario, "--out", run, "--quiet"]
    for path, value in entry["set"].items():
        command += ["--set", f"{path}={json.dumps(value)}"]
    start = time.monotonic()
    called(command)
    flown = time.monotonic()
    metrics = json.loads((run / "metrics.json").read_text())
    estimator = metrics["estimators"]["feature"]
    out = args.results / "explained" / entry["name"]
    shutil.rmtree(out, ignore_errors=True)
    answer = json.loads(called([args.binary, "explain", run, "--out", out, "--json", "--quiet",
                                "--flights", args.flights]))
    return {"name": entry["name"], "planted": entry.get("cause"),
            "outcome": estimator["outcome"], "necessary": answer["necessary"],
            "sufficient": answer["sufficient"], "reproduced": answer["reproduced"],
            "sentences": answer["sentences"],
            "flights": len(answer["flights"]), "flight_s": round(flown - start, 1),
            "explain_s": round(time.monotonic() - flown, 1)}


def judged(result):
    named = set(result["necessary"]) | set(result["sufficient"])
    failed = not result["outcome"].startswith("COMPLETED")
    if result["planted"] is None:
        return "succeeded, nothing named" if not failed and not named else "WRONG"
    if not failed:
        return "SUCCEEDED"
    return "right" if named == {result["planted"]} else "wrong"


def table(results):
    print("| flight | planted | outcome | necessary | sufficient | flights | |")
    print("|---|---|---|---|---|---|---|")
    for result in results:
        print("| " + " | ".join([
            result["name"], result["planted"] or "-", result["outcome"],
            ", ".join(result["necessary"]) or "-", ", ".join(result["sufficient"]) or "-",
            str(result["flights"]), judged(result)]) + " |")


def main():
    args = arguments()
    entries = json.loads(args.list.read_text())
    args.results.mkdir(parents=True, exist_ok=True)
    scenario = args.results / "scenario.json"
    scenario.write_text(json.dumps(entries["scenario"], indent=2))
    results = []
    for entry in entries["flights"]:
        if args.only and entry["name"] not in args.only:
            continue
        file = args.results / (entry["name"] + ".json")
        if not file.exists() and not args.table:
            file.write_text(json.dumps(explained(args, scenario, entry), indent=1))
            print(f"{entry['name']}: {judged(json.loads(file.read_text()))}", file=sys.stderr)
        if file.exists():
            results.append(json.loads(file.read_text()))
    table(results)
    planted = [judged(result) for result in results if result["planted"]]
    innocent = [judged(result) for result in results if not result["planted"]]
    print(f"\n{planted.count('right')} of {len(planted)} planted causes named correctly; "
          f"{innocent.count('WRONG')} of {len(innocent)} other flights wrong; "
          f"{sum(r['flights'] for r in results)} flights, "
          f"{sum(r['flight_s'] + r['explain_s'] for r in results):.0f} s")
    if "SUCCEEDED" in planted or "WRONG" in innocent:
        sys.exit(1)
    sys.exit(0 if planted.count("right") >= LEAST_SHARE_NAMED * len(planted) else 1)


if __name__ == "__main__":
    main()
