#!/usr/bin/env python3
"""Scores of 50 random flights, computed without any of the project's code.

    python3 tests/reference/evaluation/make_scores.py > tests/reference/evaluation/scores.txt

The definitions are those of the trajectory literature (ATE and RPE as commonly printed): positions
compared after alignment, rotation error as geodesic angle, KITTI's errors per distance. Only the
standard library is used, and other methods than the program's where there are any: Horn's
quaternion eigenvector (Horn 1987, doi:10.1364/JOSAA.4.000629) by Jacobi sweeps in place of a
singular value decomposition, a root search for the yaw. The flights come from an integer generator
that tests/evaluation/reference_test.cpp repeats, which also fits first_sim3 to FIRST_NS.

Each line: flight, association, mode, scale, then position RMSE, mean, median, maximum, position
RMSE with held poses [m], rotation RMSE geodesic, Euler norm [deg], and for 10 m and 40 m pieces the
number of pieces, RMS and mean translation [%] and RMS and mean rotation [deg / 100 m].
"""
import bisect
import math

DT_NS = 32258065
FIRST_NS = 2_000_000_000  # of first_sim3: the flights are shorter than the 10 s of the program
LENGTHS_M = (10.0, 40.0)


class Generator:
    """Knuth's MMIX linear congruential generator, the upper 53 bits as a double in [0, 1)."""

    def __init__(self, seed):
        self.state = seed

    def uniform(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (self.state >> 11) * 2.0**-53

    def centred(self):
        return self.uniform() - 0.5


# Quaternions are (w, x, y, z), Hamilton.
def q_mul(a, b):
    return (a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0])


def q_conj(q):
    return (q[0], -q[1], -q[2], -q[3])


def q_unit(q):
    n = math.sqrt(sum(c * c for c in q))
    return tuple(c / n for c in q)


def q_rotate(q, v):
    return q_mul(q_mul(q, (0.0,) + tuple(v)), q_conj(q))[1:]


def q_angle(a, b):
    d = q_mul(q_conj(a), b)
    return 2.0 * math.atan2(math.sqrt(d[1] ** 2 + d[2] ** 2 + d[3] ** 2), abs(d[0]))


def slerp(a, b, alpha):
    d = sum(x * y for x, y in zip(a, b))
    if d < 0.0:
        b, d = tuple(-c for c in b), -d
    theta = 2.0 * math.atan2(math.dist(a, b), math.dist(a, tuple(-c for c in b)))
    if theta < 1e-12:
        return a
    f, g = math.sin((1.0 - alpha) * theta), math.sin(alpha * theta)
    return q_unit(tuple((f * x + g * y) / math.sin(theta) for x, y in zip(a, b)))


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def norm(a):
    return math.sqrt(dot(a, a))


def scaled(s, a):
    return tuple(s * x for x in a)


def make_flight(index):
    g = Generator(1000 + index)
    count = 80 + int(g.uniform() * 60)
    p, v, q = (0.0, 0.0, 300.0), (1.0, 0.5, 0.0), (1.0, 0.0, 0.0, 0.0)
    truth = []
    for i in range(count):
        truth.append((i * DT_NS, p, q))
        v = add(v, (g.centred(), g.centred(), 0.5 * g.centred()))
        p = add(p, v)
        q = q_unit(add(q, (0.3 * g.centred(), 0.3 * g.centred(), 0.3 * g.centred(),
                           0.3 * g.centred())))
    scale = 0.1 + 3.0 * g.uniform()
    rotation = q_unit((g.centred(), g.centred(), g.centred(), g.centred()))
    shift = (100.0 * g.centred(), 100.0 * g.centred(), 100.0 * g.centred())
    late_ns = int(g.uniform() * 8e6)
    begin = int(g.uniform() * 5)
    gap = 20 + int(g.uniform() * 20)
    end = count - int(g.uniform() * 20)
    depth = 1.0 + g.uniform()
    true_depth = 250.0 + 100.0 * g.uniform()
    samples = []
    for i in range(count):
        t_ns, p, q = truth[i]
        noise = (g.centred(), g.centred(), g.centred())
        turn = q_unit((1.0, 0.05 * g.centred(), 0.05 * g.centred(), 0.05 * g.centred()))
        p_vo = add(scaled(1.0 / scale, q_rotate(q_conj(rotation), sub(p, shift))),
                   scaled(1.0 / scale, noise))
        q_vo = q_mul(q_mul(q_conj(rotation), q), turn)
        tracked = begin <= i < end and not gap <= i < gap + 3
        samples.append((t_ns + late_ns, tracked, p_vo, q_vo))
    return truth, samples, depth, true_depth


def truth_interpolated(truth, t_ns):
    times = [t for t, _, _ in truth]
    i = bisect.bisect_right(times, t_ns)
    if i == len(times):
        return None
    (t0, p0, q0), (t1, p1, q1) = truth[i - 1], truth[i]
    alpha = (t_ns - t0) / (t1 - t0)
    return add(p0, scaled(alpha, sub(p1, p0))), slerp(q0, q1, alpha)


def truth_nearest(truth, t_ns):
    t, p, q = min(truth, key=lambda pose: abs(pose[0] - t_ns))
    return (p, q) if abs(t - t_ns) <= 10_000_000 else None


def largest_eigenvector(m):
    """Of a symmetric 4x4 matrix, by cyclic Jacobi rotations."""
    a = [row[:] for row in m]
    v = [[float(i == j) for j in range(4)] for i in range(4)]
    for _ in range(60):
        for i in range(3):
            for j in range(i + 1, 4):
                if a[i][j] == 0.0:
                    continue
                theta = 0.5 * math.atan2(2.0 * a[i][j], a[j][j] - a[i][i])
                c, s = math.cos(theta), math.sin(theta)
                for k in range(4):
                    a[k][i], a[k][j] = c * a[k][i] - s * a[k][j], s * a[k][i] + c * a[k][j]
                for k in range(4):
                    a[i][k], a[j][k] = c * a[i][k] - s * a[j][k], s * a[i][k] + c * a[j][k]
                for k in range(4):
                    v[k][i], v[k][j] = c * v[k][i] - s * v[k][j], s * v[k][i] + c * v[k][j]
    best = max(range(4), key=lambda i: a[i][i])
    return q_unit(tuple(v[k][best] for k in range(4)))


def horn(xs, ys):
    """The unit quaternion that maximises sum y . R x."""
    s = [[sum(x[i] * y[j] for x, y in zip(xs, ys)) for j in range(3)] for i in range(3)]
    (sxx, sxy, sxz), (syx, syy, syz), (szx, szy, szz) = s
    return largest_eigenvector([
        [sxx + syy + szz, syz - szy, szx - sxz, sxy - syx],
        [syz - szy, sxx - syy - szz, sxy + syx, szx + sxz],
        [szx - sxz, sxy + syx, -sxx + syy - szz, syz + szy],
        [sxy - syx, szx + sxz, syz + szy, -sxx - syy + szz]])


def best_yaw(xs, ys):
    """The yaw that maximises sum y . Rz x: the falling root of its derivative."""
    def slope(yaw):
        c, s = math.cos(yaw), math.sin(yaw)
        return sum(y[0] * (-s * x[0] - c * x[1]) + y[1] * (c * x[0] - s * x[1])
                   for x, y in zip(xs, ys))
    low = next(yaw for yaw in (i * math.pi / 8 for i in range(16))
               if slope(yaw) > 0.0 >= slope(yaw + math.pi / 8))
    high = low + math.pi / 8
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if slope(middle) > 0.0 else (low, middle)
    return (math.cos(low / 2), 0.0, 0.0, math.sin(low / 2))


def align(mode, pairs, depth, true_depth):
    """Scale, rotation, translation of the estimate's frame in the world."""
    if mode == "first_sim3":
        first = [pair for pair in pairs if pair[4] - pairs[0][4] <= FIRST_NS]
        return align("sim3", first, depth, true_depth)
    first_x, first_y = pairs[0][2], pairs[0][0]
    if mode == "none":
        return 1.0, (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if mode in ("origin", "init_scale"):
        s = true_depth / depth if mode == "init_scale" else 1.0
        q = q_mul(pairs[0][1], q_conj(pairs[0][3]))
        return s, q, sub(first_y, scaled(s, q_rotate(q, first_x)))
    n = len(pairs)
    if mode == "origin_sim3":
        mx, my = first_x, first_y
    else:
        mx = tuple(sum(pair[2][i] for pair in pairs) / n for i in range(3))
        my = tuple(sum(pair[0][i] for pair in pairs) / n for i in range(3))
    xs = [sub(pair[2], mx) for pair in pairs]
    ys = [sub(pair[0], my) for pair in pairs]
    q = best_yaw(xs, ys) if mode == "yaw_only" else horn(xs, ys)
    s = 1.0
    if mode in ("sim3", "origin_sim3"):
        s = sum(dot(y, q_rotate(q, x)) for x, y in zip(xs, ys)) / sum(dot(x, x) for x in xs)
    return s, q, sub(my, scaled(s, q_rotate(q, mx)))


def euler_of_body(q_world_camera):
    """Roll, pitch, yaw of the body under a nadir camera, body and NED by their axes."""
    nose = q_rotate(q_world_camera, (0.0, -1.0, 0.0))
    right = q_rotate(q_world_camera, (1.0, 0.0, 0.0))
    down = q_rotate(q_world_camera, (0.0, 0.0, 1.0))
    yaw = math.atan2(nose[0], nose[1])
    pitch = math.asin(max(-1.0, min(1.0, nose[2])))
    roll = math.atan2(-right[2], -down[2])
    return roll, pitch, yaw


def wrapped(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def relative(pairs, aligned, length):
    way = [0.0]
    for a, b in zip(pairs, pairs[1:]):
        way.append(way[-1] + norm(sub(b[0], a[0])))
    t_errors, r_errors = [], []
    for first in range(0, len(pairs), 10):
        last = next((i for i in range(first, len(way)) if way[i] > way[first] + length), None)
        if last is None:
            continue
        def step(p0, q0, p1, q1):
            return q_rotate(q_conj(q0), sub(p1, p0)), q_mul(q_conj(q0), q1)
        tp, tq = step(*pairs[first][:2], *pairs[last][:2])
        ep, eq = step(*aligned[first], *aligned[last])
        t_errors.append(norm(sub(tp, ep)) / length)
        r_errors.append(q_angle(tq, eq) / length)
    if not t_errors:
        return [0, 0.0, 0.0, 0.0, 0.0]
    degrees = math.degrees(100.0)
    return [len(t_errors), 100.0 * rms(t_errors), 100.0 * sum(t_errors) / len(t_errors),
            degrees * rms(r_errors), degrees * sum(r_errors) / len(r_errors)]


def scores(index, association, mode):
    truth, samples, depth, true_depth = make_flight(index)
    look = truth_interpolated if association == "interpolate" else truth_nearest
    pairs, held, last = [], [], None
    for t_ns, tracked, p_vo, q_vo in samples:
        pose = look(truth, t_ns)
        if tracked:
            last = p_vo
        if last is None or pose is None:
            continue
        held.append((pose[0], last))
        if tracked:
            pairs.append((*pose, p_vo, q_vo, t_ns))
    s, q, t = align(mode, pairs, depth, true_depth)
    aligned = [(add(scaled(s, q_rotate(q, p)), t), q_mul(q, r)) for _, _, p, r, _ in pairs]
    positions = [norm(sub(a[0], pair[0])) for a, pair in zip(aligned, pairs)]
    hold = [norm(sub(add(scaled(s, q_rotate(q, p)), t), truth_p)) for truth_p, p in held]
    angles = [math.degrees(q_angle(a[1], pair[1])) for a, pair in zip(aligned, pairs)]
    eulers = [math.degrees(norm([wrapped(x - y) for x, y in
                                 zip(euler_of_body(a[1]), euler_of_body(pair[1]))]))
              for a, pair in zip(aligned, pairs)]
    ordered = sorted(positions)
    half = len(ordered) // 2
    median = ordered[half] if len(ordered) % 2 else 0.5 * (ordered[half - 1] + ordered[half])
    row = [s, rms(positions), sum(positions) / len(positions), median, ordered[-1], rms(hold),
           rms(angles), rms(eulers)]
    for length in LENGTHS_M:
        row += relative(pairs, aligned, length)
    return row


def main():
    modes = ("none", "origin", "init_scale", "se3", "sim3", "yaw_only", "origin_sim3",
             "first_sim3")
    for index in range(50):
        association = "interpolate" if index % 2 == 0 else "nearest"
        for mode in modes:
            numbers = " ".join(f"{value:.12g}" for value in scores(index, association, mode))
            print(index, association, mode, numbers)


if __name__ == "__main__":
    main()
