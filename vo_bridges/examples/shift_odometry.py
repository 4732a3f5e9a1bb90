#!/usr/bin/env python3
"""Example for a camera that looks straight down and keeps its heading and its height.

Aligns the brightness sums of each row and of each column with those of the previous frame.
Unit: the height. Fails in turns, banks and climbs: a starting point, not a competitor.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "client"))
import overfly_vo  # noqa: E402


def shift_of(now, before, shift):
    """Position of the middle of `now` in `before` [px], by Gauss-Newton from `shift`."""
    rim = len(now) // 4
    slopes = [(now[i + 1] - now[i - 1]) / 2 for i in range(rim, len(now) - rim)]
    rise = sum(slope * slope for slope in slopes)
    for _ in range(30):
        whole = math.floor(shift) if math.isfinite(shift) else rim
        if not -rim <= whole < rim:
            break
        error = sum(slope * ((1 + whole - shift) * before[i + whole]
                             + (shift - whole) * before[i + whole + 1] - now[i])
                    for i, slope in enumerate(slopes, rim))
        step = error / rise if rise > 0.0 else math.inf
        shift -= step
        if abs(step) < 1e-3:
            return shift
    return math.nan


class ShiftOdometry(overfly_vo.Estimator):
    name = "shift_odometry"

    def calibrate(self, calibration):
        self.focal_px = calibration.fx_px
        self.before, self.shift, self.position = None, (0.0, 0.0), (0.0, 0.0)

    def track(self, frame):
        columns = [sum(frame.pixels[x::frame.width_px]) for x in range(frame.width_px)]
        rows = [sum(frame.pixels[y * frame.width_px:(y + 1) * frame.width_px])
                for y in range(frame.height_px)]
        now, before = (columns, rows), self.before or (columns, rows)
        self.shift = tuple(shift_of(*pair) for pair in zip(now, before, self.shift))
        self.before = now
        self.position = tuple(p + s / self.focal_px for p, s in zip(self.position, self.shift))
        state = overfly_vo.TRACKING if math.isfinite(sum(self.position)) else overfly_vo.LOST
        picture = (frame.width_px, frame.height_px, 1, frame.pixels)
        return overfly_vo.Answer(state=state, position=(*self.position, 0.0), scene_depth=1.0,
                                 debug_image=picture if frame.debug_wanted else None)


overfly_vo.run(ShiftOdometry())
