#!/usr/bin/env python3
"""Prints the results that fly.py left in a folder as one table. Usage: summary.py RESULTS_FOLDER"""

import json
import pathlib
import sys


def number(value, digits):
    return "-" if value is None else f"{value:.{digits}f}"


def row(result):
    estimator = result["estimator"]
    alignments = estimator["alignments"]
    init = alignments.get("init_scale", {})
    sim3 = alignments.get("sim3", {})
    return [
        result["name"],
        estimator["outcome"],
        number(100 * estimator["coverage"], 1),
        number(init.get("position_rmse_m"), 2),
        number(sim3.get("position_rmse_m"), 2),
        number(init.get("rotation_rmse_deg"), 3),
        number(sim3.get("rotation_rmse_deg"), 3),
        str(result["frames"]),
        number(result["wall_s"], 0),
    ]


def main():
    header = ["flight", "outcome", "coverage %", "init_scale m", "sim3 m", "init_scale deg",
              "sim3 deg", "frames", "wall s"]
    rows = [row(json.loads(f.read_text())) for f in sorted(pathlib.Path(sys.argv[1]).glob("*.json"))]
    widths = [max(len(r[i]) for r in [header] + rows) for i in range(len(header))]
    for cells in [header] + rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(cells, widths)).rstrip())


if __name__ == "__main__":
    main()
