#!/usr/bin/env python3
"""Prints the totals of the GoogleTest programs, and which tests were skipped and why.

Usage: results.py RESULTS_FOLDER     the folder with the XML file of each suite
"""

import collections
import pathlib
import sys
import xml.etree.ElementTree


def main():
    counts = collections.Counter()
    skipped = []
    for file in sorted(pathlib.Path(sys.argv[1]).glob("*.xml")):
        counts["suites"] += 1
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
    passed = counts["tests"] - counts["failed"] - len(skipped)
    print(f'C++ tests: {counts["tests"]} in {counts["suites"]} suites: {passed} passed, '
          f'{len(skipped)} skipped, {counts["failed"]} failed')


if __name__ == "__main__":
    main()
