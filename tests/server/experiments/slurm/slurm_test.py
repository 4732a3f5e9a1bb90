#!/usr/bin/env python3
"""Flies a sweep through a real Slurm while its workers are killed, cancelled, requeued, preempted and
frozen, its controller is away and its node fails; then compares every flight with the same sweep
flown without Slurm.

Usage: slurm_test.py OVERFLY     exit code 77: skipped, with the reason
"""

import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import cluster

LEASE_S = 10
CONTROLLER_AWAY_S = 125


NATIVE = {"name": "mine", "type": "feature"}
SLOW = {"name": "mine", "type": "process",
        "command": [sys.executable, str(pathlib.Path(__file__).parent / "slow_odometry.py")]}


def sweep_file(folder: pathlib.Path, airspeeds: list[float], duration_s: float,
               estimator: dict = NATIVE, **changes: float) -> pathlib.Path:
    """A flight per airspeed, with the changed fields of the scenario."""
    scenario = pathlib.Path(__file__).parents[4] / "scenarios/course.json"
    file = folder / "sweep.json"
    file.write_text(json.dumps({
        "format_version": 1, "scenario": str(scenario),
        "set": {"duration_s": duration_s, "camera.width_px": 320, "camera.height_px": 240, **changes},
        "axes": [{"path": "flight.course.airspeed_m_s", "values": airspeeds}],
        "estimators": [estimator],
    }))
    return file


class Sweep:
    """`overfly sweep --executor slurm` in a process of its own."""

    def __init__(self, overfly: str, file: pathlib.Path, out: pathlib.Path, *options: str,
                 jobs: int = 2):
        self.out = out
        self.log = out.with_suffix(".log")
        self.words = [overfly, "sweep", str(file), "--out", str(out), "--executor", "slurm",
                      "--jobs", str(jobs), "--lease-s", str(LEASE_S), *options]
        self.start()

    def start(self) -> None:
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen(self.words, stdout=log, stderr=log)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()

    def finish(self, timeout_s: float) -> int:
        try:
            return self.process.wait(timeout=timeout_s)
        except subprocess.TimeoutExpired:
            raise RuntimeError(f"the sweep did not end within {timeout_s} s\n"
                               f"{self.log.read_text()[-4000:]}") from None

    def delivered(self) -> int:
        file = self.out / "results.jsonl"
        return len(file.read_text().splitlines()) if file.exists() else 0

    def workers(self) -> list[int]:
        """Process ids of workers that fly now."""
        pids = []
        for file in (self.out / "jobs/taken").iterdir():
            try:
                pids.append(int(json.loads(file.read_text())["worker"].rsplit("-", 2)[1]))
            except (OSError, ValueError, KeyError):
                pass  # Delivered in between.
        return pids


def flights(out: pathlib.Path) -> dict[str, bytes]:
    """The estimate of every completed flight, by its cell. Fails if one has two results."""
    found = {}
    for line in (out / "results.jsonl").read_text().splitlines():
        result = json.loads(line)
        assert result["status"] == "completed", line
        cell = json.dumps(result["cell"])
        assert cell not in found, f"two results of {cell}"
        scenario = json.loads((out / "scenarios" / (result["run"][5:] + ".json")).read_text())
        speed = scenario["flight"]["course"]["airspeed_m_s"]
        assert speed == result["cell"]["flight.course.airspeed_m_s"], "a result has another cell's run"
        found[cell] = (out / result["run"] / "estimates/mine.tum").read_bytes()
    return found


def refusal(overfly: str, folder: pathlib.Path) -> None:
    sweep = Sweep(overfly, sweep_file(folder, [10], 5), folder / "refused",
                  "--slurm-option=--partition=none")
    code = sweep.finish(60)
    text = sweep.log.read_text()
    assert code not in (0, 3) and "invalid partition specified: none" in text, text
    print("sbatch refuses: reported, with Slurm's reason", flush=True)


def failures(overfly: str, folder: pathlib.Path, slurm: cluster.Cluster) -> None:
    file = sweep_file(folder, [10 + 0.75 * i for i in range(22)], 16, SLOW, **{"camera.rate_hz": 1})
    pictures = folder / "pictures_of_node"
    sweep = Sweep(overfly, file, folder / "by_slurm", "--frame-cache", str(pictures))
    try:
        survive_failures(sweep, slurm)
    finally:
        sweep.kill()
    assert list(pictures.rglob("*.frame")), "workers keep pictures"
    compare_with_local(overfly, file, folder, sweep, slurm)


def survive_failures(sweep: Sweep, slurm: cluster.Cluster) -> None:
    slurm.wait_for("two workers", lambda: len(slurm.running_tasks()) == 2)

    def after_next_flight(what: str) -> None:
        seen = sweep.delivered()
        slurm.wait_for("a flight in progress", lambda: sweep.process.poll() is not None or
                       (sweep.delivered() > seen and sweep.workers()), 120)
        assert sweep.process.poll() is None, f"over before: {what}\n{sweep.log.read_text()}"
        print(f"{sweep.delivered():2d} flights over: {what}", flush=True)

    after_next_flight("a worker is killed (as for its memory)")
    os.kill(sweep.workers()[0], signal.SIGKILL)
    after_next_flight("a task is cancelled")
    slurm.text("scancel", slurm.running_tasks()[0])
    after_next_flight("a task is requeued")
    subprocess.run(["scontrol", "requeue", slurm.running_tasks()[0]], check=True)
    after_next_flight("a worker is frozen beyond its lease")
    frozen = freeze_worker(sweep, slurm)
    slurm.wait_for("loss of the frozen worker",
                   lambda: f"-{frozen}-" in sweep.log.read_text())
    os.kill(frozen, signal.SIGCONT)
    after_next_flight("both tasks are preempted by a job of higher priority")
    subprocess.run(["sbatch", "--partition=high", "--ntasks=2", "--mem=100M", "--output=/dev/null",
                    "--wrap=sleep 2"], check=True, stdout=subprocess.DEVNULL)
    slurm.wait_for("the job of higher priority",
                   lambda: "high" in slurm.text("squeue", "-h", "-t", "R", "-o", "%P"))
    after_next_flight("the node is set down")
    subprocess.run(["scontrol", "update", f"nodename={slurm.node}", "state=down", "reason=test"],
                   check=True)
    time.sleep(3)
    # Refused if the node has already come back by itself (ReturnToService).
    slurm.text("scontrol", "update", f"nodename={slurm.node}", "state=resume")
    after_next_flight("the node loses its daemon and its workers at once")
    slurm.kill_node()
    for pid in sweep.workers():
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    slurm.wait_for("the loss of the node", lambda: "down" in slurm.node_state(), 150)
    slurm.start_node()
    after_next_flight(f"Slurm's controller is away for {CONTROLLER_AWAY_S} s, and this one is killed "
                      "and started again meanwhile")
    slurm.kill_controller()
    time.sleep(4)
    sweep.kill()
    sweep.start()
    time.sleep(CONTROLLER_AWAY_S - 4)
    print(f"{sweep.delivered():2d} flights over: Slurm's controller comes back", flush=True)
    slurm.start_controller()
    slurm.wait_for("Slurm's controller", lambda: slurm.text("squeue", "-h", "-o", "%i") or
                   slurm.text("sinfo", "-h"))
    # The controller has forgotten that the node has these tasks, and drains it.
    slurm.wait_for("the end of the sweep", lambda: over_or_resumed(sweep, slurm), 300)
    assert sweep.process.returncode == 0, sweep.log.read_text()


def over_or_resumed(sweep: Sweep, slurm: cluster.Cluster) -> bool:
    """True if the sweep is over. A drained node is taken back into service, as an administrator would."""
    if "drain" in slurm.node_state():
        slurm.text("scontrol", "update", f"nodename={slurm.node}", "state=resume")
    return sweep.process.poll() is not None


def freeze_worker(sweep: Sweep, slurm: cluster.Cluster) -> int:
    """The process id of a stopped worker that holds a flight."""
    pid = 0

    def frozen() -> bool:
        nonlocal pid
        for pid in sweep.workers():
            try:
                os.kill(pid, signal.SIGSTOP)
            except ProcessLookupError:
                continue  # Killed before; its flight has not been given up yet.
            if pid in sweep.workers():
                return True
            os.kill(pid, signal.SIGCONT)  # It had just delivered: nothing would be lost.
        return False

    slurm.wait_for("a worker to freeze", frozen)
    return pid


def compare_with_local(overfly: str, file: pathlib.Path, folder: pathlib.Path, sweep: Sweep,
                       slurm: cluster.Cluster) -> None:
    local = folder / "local"
    subprocess.run([overfly, "sweep", str(file), "--out", str(local), "--jobs", "6", "--quiet"],
                   check=True, stdout=subprocess.DEVNULL)
    by_slurm = flights(sweep.out)
    assert by_slurm == flights(local), "flights differ from those without Slurm"
    # If the sweep ended while the controller was away, nothing could cancel what that holds since.
    slurm.wait_for("an empty queue", lambda: set(slurm.text("squeue", "-h", "-o", "%r").splitlines())
                   <= {"launch failed requeued held"}, 150)
    left = [path for kind in ("open", "taken", "delivered", "flights")
            for path in (sweep.out / "jobs" / kind).iterdir()]
    assert not left, left
    print(f"{len(by_slurm)} flights, each once, and equal to those flown without Slurm", flush=True)
    print(sweep.log.read_text())


def main() -> int:
    overfly = sys.argv[1]
    reason = cluster.missing()
    if reason:
        print(f"skipped: {reason}")
        return cluster.SKIPPED
    # The cluster is stopped too when this test is interrupted.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    with tempfile.TemporaryDirectory(prefix="overfly-slurm-", ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        slurm = cluster.Cluster(folder / "cluster")
        try:
            try:
                slurm.start()
            except RuntimeError as error:
                print(f"skipped: Slurm does not run here: {error}")
                return cluster.SKIPPED
            refusal(overfly, folder)
            failures(overfly, folder, slurm)
        finally:
            slurm.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
