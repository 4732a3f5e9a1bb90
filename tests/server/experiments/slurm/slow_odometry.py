"""An estimator that takes half a second per frame and no processor time, and whose poses depend on the
images: a flight takes as long on any machine, and no other flight has its poses."""
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[4] / "vo_bridges/client"))
import overfly_vo  # noqa: E402

PAUSE_S = 0.5


class SlowOdometry(overfly_vo.Estimator):
    name = "slow_odometry"

    def track(self, frame):
        time.sleep(PAUSE_S)
        brightness = sum(frame.pixels) / len(frame.pixels)
        return overfly_vo.Answer(state=overfly_vo.TRACKING, position=(brightness, float(frame.index), 0.0),
                                 scene_depth=1.0)


overfly_vo.run(SlowOdometry())
