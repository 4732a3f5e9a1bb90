#!/usr/bin/env python3
"""Fits the risk model of `overfly predict` to the flights of predict_flights.py, and judges it.

Usage: predict_fit.py BINARY RESULTS_FOLDER [--jobs N] [--table FILE] [--coefficients FILE] [--keep]

For each flight that was flown, `overfly predict` computes the features (stored as
RESULTS_FOLDER/features/NAME.json; --keep uses those that exist). The windows of all flights and
their outcomes are written to --table (tests/server/experiments/predict/flights.csv); the model is
fitted to the flights of the set "fit" only, which also choose the strength of its penalty, and
written to --coefficients (server/experiments/predict/risk_coefficients.cpp). Printed are the flights
by outcome and by predicted risk, the area under the ROC curve of both sets, and that of models fitted
to halves of the first set.

The model is that of server/experiments/predict/risk_model.hpp: the hazard of each second is a
logistic function of the inputs. It is fitted by maximum likelihood with a ridge penalty, where
inputs that can only add risk (KINDS) keep that sign. A flight that was lost contributes its seconds
up to the loss; of one that never initialised it is not known in which second it was lost.
"""

import argparse
import concurrent.futures
import csv
import itertools
import json
import math
import pathlib
import random
import subprocess
import sys

from predict_worlds import FITTING, JUDGING, PHOTOGRAPHS

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROOM = "server/experiments/predict"
INPUTS = ["texels", "corners", "bare", "similarity", "relief", "rotation", "translation", "overlap",
          "blur", "noise", "void", "sun"]
# -1: more of it can only lower the risk; 1: only raise it; 0: either.
KINDS = [-1, -1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1]
# Strengths of the penalty that are tried: the one with which worlds left out of the fitting set
# are judged best is used.
RIDGES = [3.0, 10.0, 30.0, 100.0, 300.0]
STEPS = 12  # of the iteration
RISK_BOUNDS_PERCENT = [0, 25, 50, 75, 90, 101]


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--table", type=pathlib.Path, default=ROOT / "tests" / ROOM / "flights.csv")
    parser.add_argument("--coefficients", type=pathlib.Path,
                        default=ROOT / ROOM / "risk_coefficients.cpp")
    parser.add_argument("--keep", action="store_true")
    return parser.parse_args()


def features(args, name):
    """The windows of a flight at whole seconds, each the values of INPUTS."""
    stored = args.results / "features" / f"{name}.json"
    if not (args.keep and stored.exists()):
        scenario = args.results / "flights" / f"{name}.scenario.json"
        done = subprocess.run([str(args.binary), "predict", str(scenario), "--json", "--quiet",
                               "--no-map", "--jobs", "1"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{name}: {done.stderr[-500:]}")
        stored.write_text(done.stdout)
    instants = json.loads(stored.read_text())["instants"]
    return [[instant["inputs"][key] for key in INPUTS] for instant in instants
            if instant["t_s"] > 0 and abs(instant["t_s"] - round(instant["t_s"])) < 1e-6]


def flights_of(args):
    """Every flown flight with its windows, sets alternating."""
    (args.results / "features").mkdir(exist_ok=True)
    results = sorted((args.results / "flights").glob("*.result.json"))
    flights = [json.loads(file.read_text()) for file in results]
    names = [f"{flight['set']}_{flight['number']:03d}" for flight in flights]
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for flight, windows in zip(flights, pool.map(lambda name: features(args, name), names)):
            flight["windows"] = [[float(f"{value:.4g}") for value in row] for row in windows]
    return flights


def lost(flight):
    return flight["outcome"] != "COMPLETED"


def lost_second(flight):
    """The second of the loss, from 1; None if there is none or it is not known."""
    if not lost(flight):
        return None
    time_s = flight["outcome_time_s"]
    if flight["outcome"] == "NOT_INITIALISED" or time_s is None:
        return None
    return min(max(1, math.ceil(time_s)), len(flight["windows"]))


def write_table(flights, file):
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["set", "flight", "world", "outcome", "lost_s", "second", *INPUTS])
        for flight in flights:
            for second, window in enumerate(flight["windows"], 1):
                writer.writerow([flight["set"], flight["number"], flight["world"],
                                 flight["outcome"], lost_second(flight) or "", second,
                                 *(f"{value:.4g}" for value in window)])


def solved(matrix, vector):
    """Gaussian elimination with pivoting."""
    n = len(vector)
    rows = [list(row) + [value] for row, value in zip(matrix, vector)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(i + 1, n):
            factor = rows[r][i] / rows[i][i]
            for c in range(i, n + 1):
                rows[r][c] -= factor * rows[i][c]
    result = [0.0] * n
    for i in reversed(range(n)):
        result[i] = (rows[i][n] - sum(rows[i][c] * result[c] for c in range(i + 1, n))) / rows[i][i]
    return result


def logistic(value):
    return 1 / (1 + math.exp(-value)) if value > -500 else 0.0


def fitted(flights, ridge):
    """(bias, mean, scale, weight) of the model: maximum of the penalised likelihood.

    Expectation maximisation (Dempster, Laird, Rubin 1977) with one step of Newton's method in each
    iteration: the second in which an estimator that never started was lost is not known.
    """
    known = [flight["windows"][:lost_second(flight)] for flight in flights]
    n = len(INPUTS)
    rows = [window for windows in known for window in windows]
    mean = [sum(row[i] for row in rows) / len(rows) for i in range(n)]
    scale = [max(1e-3, math.sqrt(sum((row[i] - mean[i]) ** 2 for row in rows) / len(rows)))
             for i in range(n)]
    cases = [([[1.0] + [(row[i] - mean[i]) / scale[i] for i in range(n)] for row in windows],
              lost(flight), lost(flight) and lost_second(flight) is None)
             for windows, flight in zip(known, flights)]
    used = list(range(n + 1))
    beta = [-2.0] + [0.0] * n
    while True:
        for _ in range(STEPS):
            newton_step(weighted(cases, beta), beta, used, ridge)
        wrong = [i for i in used if i and KINDS[i - 1] * beta[i] < 0]
        if not wrong:
            return beta[0], mean, scale, beta[1:]
        worst = max(wrong, key=lambda i: abs(beta[i]))
        used.remove(worst)
        beta[worst] = 0.0


def weighted(cases, beta):
    """Rows (x, probability of a loss in this second, probability that it was reached)."""
    rows = []
    for windows, is_lost, unknown in cases:
        if not unknown:
            last = len(windows) - 1
            rows += [(x, 1.0 if is_lost and k == last else 0.0, 1.0)
                     for k, x in enumerate(windows)]
            continue
        survival, losses = 1.0, []
        for x in windows:
            hazard = logistic(sum(b * v for b, v in zip(beta, x)))
            losses.append(survival * hazard)
            survival *= 1 - hazard
        total = sum(losses)
        reached = 1.0
        for x, loss in zip(windows, losses):
            rows.append((x, loss / total, reached))
            reached -= loss / total
    return rows


def newton_step(rows, beta, used, ridge):
    size = len(used)
    gradient = [-ridge * beta[i] if i else 0.0 for i in used]
    hessian = [[ridge if a == b and used[a] else 0.0 for b in range(size)] for a in range(size)]
    for x, loss, reached in rows:
        x = [x[i] for i in used]
        p = logistic(sum(beta[i] * v for i, v in zip(used, x)))
        error, weight = loss - reached * p, reached * p * (1 - p)
        for a, v in enumerate(x):
            gradient[a] += error * v
            line, wv = hessian[a], weight * v
            for b in range(a + 1):
                line[b] += wv * x[b]
    for a in range(size):
        for b in range(a):
            hessian[b][a] = hessian[a][b]
    for i, step in zip(used, solved(hessian, gradient)):
        beta[i] += max(-1.0, min(1.0, step))


def flight_risk(model, flight):
    bias, mean, scale, weight = model
    survival = 1.0
    for window in flight["windows"]:
        survival *= 1 - logistic(bias + sum(
            w * (x - m) / s for w, x, m, s in zip(weight, window, mean, scale)))
    return 1 - survival


def roc_area(model, flights):
    return area_of([(flight_risk(model, flight), lost(flight)) for flight in flights])


def area_of(judged):
    positive = [risk for risk, is_lost in judged if is_lost]
    negative = [risk for risk, is_lost in judged if not is_lost]
    wins = sum((p > n) + 0.5 * (p == n) for p in positive for n in negative)
    pairs = len(positive) * len(negative)
    return wins / pairs if pairs else float("nan")


def left_out_area(flights, ridge):
    """The area when each world of the fitting set is judged by a model of the others."""
    judged = []
    for world in FITTING:
        others = [flight for flight in flights if flight["world"] != world]
        model = fitted(others, ridge)
        judged += [(flight_risk(model, flight), lost(flight))
                   for flight in flights if flight["world"] == world]
    return area_of(judged)


def numbers(values):
    return ",\n".join(f"       {value:.6g}" for value in values)


def write_coefficients(model, flights, file):
    bias, mean, scale, weight = model
    fit = [flight for flight in flights if flight["set"] == "fit"]
    count = sum(lost(flight) for flight in fit)
    file.write_text(f"""// Written by tests/flights/predict_fit.py from tests/{ROOM}/flights.csv.
// Fitted to {len(fit)} flights of 10 s with the native estimator, {count} lost and {len(fit) - count} completed, over the worlds
// {", ".join(FITTING)} (tests/flights/predict_worlds.py).
// Each value: {", ".join(INPUTS)}.
#include "{ROOM}/risk_model.hpp"

namespace overfly::server::predict {{

const RiskModel& fitted_model() {{
  static const RiskModel model{{
      {bias:.6g},
      {{{numbers(mean).strip()}}},
      {{{numbers(scale).strip()}}},
      {{{numbers(weight).strip()}}}}};
  return model;
}}

}}  // namespace overfly::server::predict
""")
    subprocess.run(["clang-format", "-i", str(file)], check=False)


def report(model, flights):
    print("| set | flights | lost | completed | area under the ROC curve |\n|---|---|---|---|---|")
    judged = [flight for flight in flights if flight["set"] == "judge"]
    sets = {"fitted": [flight for flight in flights if flight["set"] == "fit"],
            "other worlds": judged,
            "of these, photographs": [f for f in judged if f["world"] in PHOTOGRAPHS],
            "of these, built": [f for f in judged if f["world"] not in PHOTOGRAPHS]}
    for name, some in sets.items():
        count = sum(lost(flight) for flight in some)
        print(f"| {name} | {len(some)} | {count} | {len(some) - count} | "
              f"{roc_area(model, some):.3f} |")
    print("\nFlights of the other worlds that were lost, by predicted risk: " + ", ".join(
        f"{low:g} to {min(high, 100):g} %: {sum(map(lost, some))} of {len(some)}"
        for low, high in itertools.pairwise(RISK_BOUNDS_PERCENT)
        if (some := [f for f in judged if low <= 100 * flight_risk(model, f) < high])))
    print("\n| world | lost | completed |\n|---|---|---|")
    for world in [*FITTING, *JUDGING]:
        some = [flight for flight in flights if flight["world"] == world]
        print(f"| {world} | {sum(map(lost, some))} | {len(some) - sum(map(lost, some))} |")
    print("\n| input | mean | scale | log odds per scale |\n|---|---|---|---|")
    for row in zip(INPUTS, *model[1:]):
        print("| {} | {:.3f} | {:.3f} | {:+.3f} |".format(*row))


def report_subsets(fit, judged, ridge):
    """How much the area over the other worlds depends on which flights the model is fitted to."""
    chance = random.Random(1)
    halves = [chance.sample(fit, len(fit) // 2) for _ in range(6)]
    areas = [roc_area(fitted(half, ridge), judged) for half in [fit[:len(fit) // 2], *halves]]
    print(f"\nArea over the other worlds if fitted to the first half of the flights: {areas[0]:.3f}; "
          "to random halves: " + ", ".join(f"{area:.3f}" for area in areas[1:]))


def main():
    args = arguments()
    flights = flights_of(args)
    write_table(flights, args.table)
    fit = [flight for flight in flights if flight["set"] == "fit"]
    areas = {ridge: left_out_area(fit, ridge) for ridge in RIDGES}
    print("Area over worlds left out of the fitting set, by the penalty: " +
          ", ".join(f"{ridge:g}: {area:.3f}" for ridge, area in areas.items()) + "\n")
    ridge = max(areas, key=areas.get)
    model = fitted(fit, ridge)
    write_coefficients(model, flights, args.coefficients)
    report(model, flights)
    report_subsets(fit, [flight for flight in flights if flight["set"] == "judge"], ridge)


if __name__ == "__main__":
    main()
