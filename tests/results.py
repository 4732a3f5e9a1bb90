#!/usr/bin/env python3
"""Prints the totals of the GoogleTest programs, and which tests were skipped and why.

Usage: results.py BUILD_FOLDER

Reads the XML file that each suite leaves in BUILD_FOLDER/test-results, and asks ctest for the suites
(cmake/AddTestSuites.cmake). The exit code is 1 if a suite left no results, because it crashed, ran out of
time or was not run.
"""

import collections
import json
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

OUTPUT_OPTION = "--gtest_output=xml:"


def expected(build):
    """The names of all suites. Lists of suites of programs that are no longer configured do not count."""
    listing = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True,
                             stdout=subprocess.PIPE, text=True).stdout
    for test in json.loads(listing)["tests"]:
        for word in test.get("command", []):
            if word.startswith(OUTPUT_OPTION):
                yield pathlib.Path(word.removeprefix(OUTPUT_OPTION)).stem


def main():
    build = pathlib.Path(sys.argv[1])
    counts = collections.Counter()
    skipped = []
    files = sorted((build / "test-results").glob("*.xml"))
    for file in files:
        for case in xml.etree.ElementTree.parse(file).getroot().iter("testcase"):
            if case.get("status") == "notrun":
                continue
            counts["tests"] += 1
            name = f'{file.stem}.{case.get("name")}'
            if case.find("failure") is not None:
                counts["failed"] += 1
                print(f"failed: {name}")
            elif (skip := case.find("skipped")) is not None:
                # The message begins with a line that has the source's file and line number.
                reason = " ".join(skip.get("message", "").split("\n")[1:]).strip()
                skipped.append(f"skipped: {name}: {reason}")
    for line in skipped:
        print(line)
    missing = sorted(set(expected(build)) - {file.stem for file in files})
    for name in missing:
        print(f"failed: {name}: the suite left no results")
    passed = counts["tests"] - counts["failed"] - len(skipped)
    print(f'C++ tests: {counts["tests"]} in {len(files)} suites: {passed} passed, '
          f'{len(skipped)} skipped, {counts["failed"]} failed, {len(missing)} suites without results')
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
