#!/usr/bin/env python3
"""Compares the wing and tail coefficients of scripts/derive-airframes with a vortex-lattice solution.

The script uses closed formulas (Helmbold, lifting line, tail volumes). Here each surface is a row of
horseshoe vortices (bound vortex at a quarter of the chord, flow tangential at three quarters: Katz &
Plotkin, Low-Speed Aerodynamics, ch. 12), solved for each motion. Bodies and viscosity are in neither.
Usage: check_derived_airframes.py SOURCE_ROOT
"""

import importlib.machinery
import importlib.util
import math
import pathlib
import sys

PANELS = 24  # of each surface
# The largest difference that is accepted, as a share of the lattice's value. The lag of the downwash
# is not part of a steady lattice, so it is taken off the pitch damping.
LIMIT = {"lift.alpha": 0.06, "pitch.alpha": 0.15, "lift.pitch_rate": 0.08, "pitch.pitch_rate": 0.08,
         "roll.roll_rate": 0.04, "roll.aileron": 0.08}


def load_script(path):
    loader = importlib.machinery.SourceFileLoader("derive_airframes", str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("derive_airframes", loader))
    loader.exec_module(module)
    return module


class Panel:
    def __init__(self, x_bound, x_control, y1, y2, z, on_tail):
        self.x_bound, self.x_control, self.y1, self.y2, self.z = x_bound, x_control, y1, y2, z
        self.y, self.width, self.on_tail = 0.5 * (y1 + y2), y2 - y1, on_tail


def surface(span, chord, x_quarter, z, on_tail):
    edges = [-0.5 * span * math.cos(math.pi * i / PANELS) for i in range(PANELS + 1)]
    return [Panel(x_quarter, x_quarter + 0.5 * chord, a, b, z, on_tail) for a, b in zip(edges, edges[1:])]


def upwash(panel, x, y, z):
    """Velocity along z at a point by a horseshoe of circulation 1 that lifts (Biot and Savart)."""
    dx, dz = x - panel.x_bound, z - panel.z
    total = 0.0
    # Trailing vortices along +x from both ends.
    for end, sign in ((panel.y1, 1.0), (panel.y2, -1.0)):
        dy = y - end
        r2 = dy * dy + dz * dz
        if r2 > 1e-12:
            total += sign * -dy / r2 * (1.0 + dx / math.sqrt(dx * dx + r2))
    # The bound vortex along y.
    h2 = dx * dx + dz * dz
    if h2 > 1e-12:
        a, b = y - panel.y1, y - panel.y2
        total -= dx / h2 * (a / math.sqrt(a * a + h2) - b / math.sqrt(b * b + h2))
    return total / (4.0 * math.pi)


def solve(matrix, right_sides):
    """Gauss with pivots, for several right sides at once."""
    n = len(matrix)
    rows = [list(matrix[i]) + [side[i] for side in right_sides] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, n):
            factor = rows[k][i] / rows[i][i]
            rows[k] = [b - factor * a for a, b in zip(rows[i], rows[k])]
    found = [[0.0] * n for _ in right_sides]
    for s, values in enumerate(found):
        for i in reversed(range(n)):
            rest = sum(rows[i][k] * values[k] for k in range(i + 1, n))
            values[i] = (rows[i][n + s] - rest) / rows[i][i]
    return found


def lattice(script, d):
    """The coefficients of wing and tail, per radian."""
    b, s = d["span"], d["area"]
    c, arm = s / b, 0.6 * d["length"]
    tail_area = d["tail_volume"] * s * c / arm
    tail_span = math.sqrt(d["tail_aspect"] * tail_area)
    x_cg = d["cg"] * c
    panels = surface(b, c, 0.25 * c, 0.0, False) + surface(
        tail_span, tail_area / tail_span, x_cg + arm, -0.05 * b, True)
    matrix = [[upwash(p, q.x_control, q.y, q.z) for p in panels] for q in panels]
    tau = script.flap(d["aileron_chord"])
    aileron = [0.0 if q.on_tail or not d["aileron"][0] <= abs(q.y) / (0.5 * b) <= d["aileron"][1]
               else -math.copysign(tau, q.y) for q in panels]
    motions = [[1.0] * len(panels),                                  # angle of attack
               [(q.x_control - x_cg) * 2.0 / c for q in panels],     # q c / (2 V) = 1
               [q.y * 2.0 / b for q in panels],                      # p b / (2 V) = 1, right wing down
               aileron]                                              # right up, left down
    def lift(g):
        return sum(2.0 * v * p.width for v, p in zip(g, panels)) / s
    def pitch(g):
        return -sum(2.0 * v * p.width * (p.x_bound - x_cg) for v, p in zip(g, panels)) / (s * c)
    def roll(g):
        return -sum(2.0 * v * p.width * p.y for v, p in zip(g, panels)) / (s * b)
    alpha, rate, rolling, deflected = solve(matrix, [[-v for v in motion] for motion in motions])
    return {"lift.alpha": lift(alpha), "pitch.alpha": pitch(alpha), "lift.pitch_rate": lift(rate),
            "pitch.pitch_rate": pitch(rate), "roll.roll_rate": roll(rolling), "roll.aileron": roll(deflected)}


def main():
    script = load_script(pathlib.Path(sys.argv[1]) / "scripts" / "derive-airframes")
    failed = False
    for name, design in script.DESIGNS.items():
        plain = dict(design, body_width=0.0, body_height=0.0)
        derived = {field: value for field, value, _, _ in script.derive(plain)}
        aspect = design["span"]**2 / design["area"]
        derived["pitch.pitch_rate"] /= 1 + 2 * script.helmbold(aspect) / (math.pi * aspect)
        for field, value in lattice(script, design).items():
            difference = derived[field] / value - 1
            wrong = abs(difference) > LIMIT[field]
            failed |= wrong
            print(f"{name:16} {field:17} derived {derived[field]:8.3f} lattice {value:8.3f} {difference:+6.1%}"
                  + (f"  more than {LIMIT[field]:.0%}" if wrong else ""))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
