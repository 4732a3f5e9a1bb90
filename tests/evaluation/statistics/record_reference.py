#!/usr/bin/env python3
"""Records what SciPy and R say of fixed samples: statistics_reference.json.

Requires python3-scipy and r-base-core: /usr/bin/python3 record_reference.py
"""

import json
import pathlib
import subprocess

import numpy as np
import scipy.stats

SAMPLES = {
    "odd": [0.3, 0.1, 2.5, 0.7, 0.2],
    "even": [0.3, 0.1, 2.5, 0.7, 0.2, 14.0, 0.9, 0.35],
    "one": [3.5],
}
P_VALUES = [[0.01, 0.04, 0.03, 0.005], [0.5, 0.9, 0.04], [0.02], [0.03, 0.03, 0.03]]
PAIRS = {
    "differ": ([0.12, 0.32, 0.18, 0.41, 0.22, 0.52, 0.36, 0.27, 0.19, 0.31, 0.24, 0.44],
               [0.10, 0.21, 0.15, 0.25, 0.20, 0.31, 0.22, 0.18, 0.17, 0.20, 0.21, 0.26]),
    "alike": ([0.12, 0.32, 0.18, 0.41, 0.22, 0.52, 0.36, 0.27, 0.19, 0.31],
              [0.15, 0.28, 0.20, 0.38, 0.25, 0.49, 0.40, 0.24, 0.22, 0.29]),
}


def holm_by_r(values):
    text = subprocess.run(
        ["Rscript", "-e", f"cat(format(p.adjust(c({','.join(map(str, values))}), 'holm'), digits=15))"],
        check=True, capture_output=True, text=True).stdout
    return [float(part) for part in text.split()]


def bootstrap_by_scipy(a, b):
    difference = np.array(a) - np.array(b)
    result = scipy.stats.bootstrap((difference,), np.median, n_resamples=400_000, batch=10_000,
                                   method="percentile", random_state=1)
    return {"median": float(np.median(difference)), "low": float(result.confidence_interval.low),
            "high": float(result.confidence_interval.high)}


def chi_square_by_scipy():
    return [{"share": share, "degrees": degrees, "quantile": float(scipy.stats.chi2.ppf(share, degrees))}
            for degrees in (1, 3, 6, 18, 1000, 33333, 6000000) for share in (0.025, 0.5, 0.95, 0.975)]


def main():
    reference = {
        "quantiles": [{"values": values, "share": share, "quantile": float(np.quantile(values, share))}
                      for values in SAMPLES.values() for share in (0.0, 0.1, 0.25, 0.5, 0.75, 0.95, 1.0)],
        "holm": [{"p": values, "adjusted": holm_by_r(values)} for values in P_VALUES],
        "chi_square": chi_square_by_scipy(),
        "bootstrap": [{"a": a, "b": b, **bootstrap_by_scipy(a, b)} for a, b in PAIRS.values()],
    }
    file = pathlib.Path(__file__).parent / "statistics_reference.json"
    file.write_text(json.dumps(reference, indent=1) + "\n")


if __name__ == "__main__":
    main()
