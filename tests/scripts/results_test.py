#!/usr/bin/env python3
"""tests/results.py demands results of the suites that ctest knows, and of no others.

Usage: results_test.py SOURCE_FOLDER
"""
import pathlib
import subprocess
import sys
import tempfile

RESULTS = pathlib.Path(sys.argv[1]) / "tests/results.py"


def count(build):
    done = subprocess.run([sys.executable, str(RESULTS), str(build)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


with tempfile.TemporaryDirectory() as name:
    build = pathlib.Path(name)
    results = build / "test-results"
    results.mkdir()
    (build / "CTestTestfile.cmake").write_text(
        f'add_test(core.Pose "{sys.executable}" "--gtest_output=xml:{results}/core.Pose.xml")\n'
        f'add_test(layers "{sys.executable}" check_layers.py)\n')
    # Left by a program that was configured earlier.
    (build / "gone").mkdir()
    (build / "gone" / "lcm_tests_suites.txt").write_text("Lcm.\n  Test\n")
    code, text = count(build)
    assert code == 1 and "failed: core.Pose: the suite left no results" in text, text
    assert "1 suites without results" in text, text
    (results / "core.Pose.xml").write_text(
        '<testsuites><testsuite><testcase name="Inverts" status="run"/></testsuite></testsuites>')
    code, text = count(build)
    assert code == 0 and "C++ tests: 1 in 1 suites: 1 passed" in text, text
