"""Connects an estimator to Overfly's process door (docs/VO_PROTOCOL.md).

One file, Python 3.9, standard library only:

    class Mine(overfly_vo.Estimator): ...
    overfly_vo.run(Mine())
"""

import array
import collections
import dataclasses
import math
import mmap
import os
import socket
import struct
import sys
import zlib

INITIALISING, TRACKING, LOST = 0, 1, 2
DEBUG, INFO, WARNING, ERROR = 0, 1, 2, 3


@dataclasses.dataclass
class Calibration:
    """Pinhole and lens; (0, 0) is the centre of the upper left pixel."""
    camera: str
    width_px: int
    height_px: int
    fx_px: float
    fy_px: float
    cx_px: float
    cy_px: float
    distortion: str  # none, radtan, equidistant, fov
    distortion_coefficients: list  # in the model's order
    rate_hz: float  # 0 = unknown


# Samples of sensors. Axes of the body are forward, right, down.
Barometer = collections.namedtuple("Barometer", "t_ns pressure_pa temperature_k")
# t_ns: measured; delivered_ns: sent by the receiver. Without a fix all that follows is NaN.
# Accuracies are standard deviations.
Gps = collections.namedtuple(
    "Gps", "t_ns delivered_ns has_fix lat_deg lon_deg alt_ellipsoid_m v_north_m_s v_east_m_s "
    "v_down_m_s horizontal_accuracy_m vertical_accuracy_m speed_accuracy_m_s")
Airspeed = collections.namedtuple("Airspeed", "t_ns differential_pressure_pa indicated_airspeed_m_s")
Magnetometer = collections.namedtuple("Magnetometer", "t_ns x_ut y_ut z_ut")
Range = collections.namedtuple("Range", "t_ns range_m")  # infinity = no echo


@dataclasses.dataclass
class Frame:
    index: int  # gaps are dropped frames
    t_ns: int  # mid exposure of the middle row
    exposure_ns: int  # 0 = unknown
    width_px: int
    height_px: int
    pixels: memoryview  # grey bytes, row by row, without padding; valid during track()
    debug_wanted: bool  # return a debug image and map points
    # Since the previous frame; empty without the sensor.
    imu: list  # (t_ns, (x, y, z) m/s2, (x, y, z) rad/s), body axes
    barometer: list = ()  # of Barometer
    gps: list = ()  # of Gps
    airspeed: list = ()  # of Airspeed
    magnetometer: list = ()  # of Magnetometer
    range: list = ()  # of Range

    def numpy(self):
        """The pixels as an array of height x width, without a copy. Requires numpy."""
        import numpy
        return numpy.frombuffer(self.pixels, numpy.uint8).reshape(self.height_px, self.width_px)


@dataclasses.dataclass
class Answer:
    """The pose is T_vo_camera (camera axes x right, y down, z forward); valid while tracking."""
    state: int = INITIALISING
    map_id: int = 0  # +1 each time the estimator restarts by itself
    position: tuple = (0.0, 0.0, 0.0)
    quaternion_xyzw: tuple = (0.0, 0.0, 0.0, 1.0)
    scene_depth: float = 0.0  # on the optical axis, or median; 0 = unknown
    counters: dict = dataclasses.field(default_factory=dict)  # names without spaces; finite values
    timings_ms: dict = dataclasses.field(default_factory=dict)
    debug_image: tuple = None  # (width_px, height_px, channels 1 or 3, bytes), if debug_wanted
    map_points: list = ()  # of (x, y, z), in the frame of position, if debug_wanted
    # Of the pose's error, row by row or as rows: 6 x 6 of position x, y, z and small rotations about
    # the fixed axes x, y, z of the frame of position [rad], or 3 x 3 of the position only.
    covariance: list = ()  # empty = not stated


class Estimator:
    """Base class. An exception is written to the run's log as an error and ends the session."""
    name = "unnamed"
    version = "0"
    lockstep = True  # each answer is awaited; False = frames missed while busy are dropped
    _connection = None

    def configure(self, wanted):
        """Takes the requested parameters {name: text}; returns all in effect {name: value}.

        Raise for an unknown parameter: ignoring it would falsify an experiment.
        """
        if wanted:
            raise ValueError(f"unknown parameter {sorted(wanted)[0]}")
        return {}

    def calibrate(self, calibration):
        """Called before the first frame; again only if that frame is of another camera."""

    def track(self, frame):
        """Returns an Answer to the Frame."""
        raise NotImplementedError

    def log(self, level, line):
        """Adds a line to the run's log."""
        self._connection.send(_LOG, struct.pack("<I", level) + line.encode()[:4096])

    def tell_parameters(self, effective):
        """Reports parameters read back from the running system."""
        self._connection.send(_PARAMETERS, _text_of(effective))


# Implementation.
_HELLO, _READY, _CALIBRATION, _FRAME, _ANSWER, _DEBUG_IMAGE = 1, 2, 3, 4, 5, 6
_MAP_POINTS, _PARAMETERS, _LOG, _STOP, _SENSORS = 7, 8, 9, 11, 12
_LARGEST_FLOAT = 3.4028234663852886e38  # of 32 bits
_HEADER = struct.Struct("<4sHHI")
_FRAME_HEAD = struct.Struct("<qqqIIIIII")
_IMU = struct.Struct("<q6d")
_SENSORS_HEAD = struct.Struct("<q6I")
_SAMPLES = (("barometer", Barometer, struct.Struct("<q2d")),
            ("gps", Gps, struct.Struct("<qqq9d")),
            ("airspeed", Airspeed, struct.Struct("<q2d")),
            ("magnetometer", Magnetometer, struct.Struct("<q3d")),
            ("range", Range, struct.Struct("<qd")))


def _text_of(parameters):
    def text(value):
        return str(value).lower() if isinstance(value, bool) else str(value)
    return "".join(f"{name} {text(value)}\n" for name, value in parameters.items()).encode()


def _lines(payload):
    for line in payload.decode().splitlines():
        key, _, value = line.partition(" ")
        yield key, value


class _Connection:
    def __init__(self, address):
        scheme, _, place = address.partition(":")
        self.local = scheme == "unix"
        if self.local:
            self._socket = socket.socket(socket.AF_UNIX)
            self._socket.connect(place)
        elif scheme == "tcp":
            host, _, port = place.rpartition(":")
            self._socket = socket.create_connection((host, int(port)))
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        else:
            raise ValueError(
                f"OVERFLY_VO_ADDRESS = '{address}': must be unix:PATH or tcp:HOST:PORT")
        self.not_finite_seen = False
        self._memory_file = None
        self._memory = None
        self._slot_bytes = 0

    def send(self, message_type, payload=b""):
        self._socket.sendall(_HEADER.pack(b"OVVO", 1, message_type, len(payload)) + payload)

    def receive(self):
        magic, version, message_type, length = _HEADER.unpack(self._bytes(_HEADER.size))
        if magic != b"OVVO":
            raise ConnectionError("not the OVVO protocol")
        if version != 1:
            raise ConnectionError(f"the server uses protocol version {version}: must be 1")
        return message_type, self._bytes(length)

    def map_frames(self, slots, slot_bytes):
        """Maps the shared memory whose descriptor was received with the calibration."""
        self._slot_bytes = slot_bytes
        self._memory = memoryview(
            mmap.mmap(self._memory_file, slots * slot_bytes, prot=mmap.PROT_READ))
        os.close(self._memory_file)
        self._memory_file = None

    def slot(self, number, count):
        return self._memory[number * self._slot_bytes:][:count]

    def _bytes(self, count):
        data = bytearray(count)
        view, got = memoryview(data), 0
        while got < count:
            room = socket.CMSG_SPACE(array.array("i").itemsize)
            n, with_it, _, _ = self._socket.recvmsg_into([view[got:]], room)
            if n == 0:
                raise ConnectionError("the server closed the connection")
            got += n
            for _, kind, descriptor in with_it:
                if kind == socket.SCM_RIGHTS:
                    self._memory_file = array.array("i", descriptor)[0]
        return data


def _calibration_from(payload, connection):
    lines = dict(_lines(payload))
    if "frame_slots" in lines:
        connection.map_frames(int(lines["frame_slots"]), int(lines["frame_slot_bytes"]))
    return Calibration(
        lines["camera"], int(lines["width_px"]), int(lines["height_px"]), float(lines["fx_px"]),
        float(lines["fy_px"]), float(lines["cx_px"]), float(lines["cy_px"]), lines["distortion"],
        [float(k) for k in lines.get("distortion_coefficients", "").split()],
        float(lines["rate_hz"]))


def _frame_from(payload, connection):
    index, t_ns, exposure_ns, width, height, _, flags, slot, samples = (
        _FRAME_HEAD.unpack_from(payload))
    at = _FRAME_HEAD.size
    imu = [(s[0], s[1:4], s[4:7]) for s in _IMU.iter_unpack(payload[at:at + samples * _IMU.size])]
    count = width * height
    pixels = (connection.slot(slot, count) if flags & 2 else
              memoryview(payload)[at + samples * _IMU.size:])
    if len(pixels) != count:
        raise ValueError(f"frame {index} has {len(pixels)} pixels: must be {count}")
    return Frame(index, t_ns, exposure_ns, width, height, pixels, bool(flags & 1), imu)


def _add_samples(payload, frame):
    counts = _SENSORS_HEAD.unpack_from(payload)[1:6]
    at = _SENSORS_HEAD.size
    for (name, kind, layout), count in zip(_SAMPLES, counts):
        end = at + count * layout.size
        samples = [kind(*values) for values in layout.iter_unpack(payload[at:end])]
        if kind is Gps:
            samples = [sample._replace(has_fix=sample.has_fix == 3) for sample in samples]
        setattr(frame, name, samples)
        at = end


def _covariance_text(covariance):
    values = []
    for row in covariance:
        values += [float(value) for value in row] if hasattr(row, "__len__") else [float(row)]
    return f"covariance {' '.join(map(repr, values))}\n" if values else ""


def _warn_not_finite(connection, what):
    if not connection.not_finite_seen:
        connection.not_finite_seen = True
        connection.send(_LOG, struct.pack("<I", WARNING) + (
            f"{what} is not finite: this and later such values are ignored").encode())


def _send_answer(connection, frame, answer, crc32):
    if frame.debug_wanted and answer.debug_image:
        width, height, channels, pixels = answer.debug_image
        connection.send(_DEBUG_IMAGE, struct.pack("<qIIII", frame.index, width, height, channels, 0)
                        + bytes(pixels))
    if frame.debug_wanted and len(answer.map_points):
        points = [point for point in answer.map_points
                  if all(abs(value) <= _LARGEST_FLOAT for value in point)]
        if len(points) < len(answer.map_points):
            _warn_not_finite(connection, "a map point")
        connection.send(_MAP_POINTS, struct.pack("<qII", frame.index, len(points), 0)
                        + b"".join(struct.pack("<3f", *point) for point in points))
    figures = [("counter", *item) for item in answer.counters.items()]
    figures += [("timing_ms", *item) for item in answer.timings_ms.items()]
    text = ""
    for key, name, figure in figures:
        value = float(figure)
        if math.isfinite(value):
            text += f"{key} {name} {value!r}\n"
        else:
            _warn_not_finite(connection, f"{key} {name}")
    text += _covariance_text(answer.covariance)
    connection.send(_ANSWER, struct.pack("<qII3d4ddII", frame.index, answer.state, answer.map_id,
                                         *answer.position, *answer.quaternion_xyzw,
                                         answer.scene_depth, crc32, 1) + text.encode())


def _greet(estimator, connection):
    offer = "shared_memory true\n" if connection.local else ""
    connection.send(_HELLO, f"protocol 1\nname {estimator.name}\n"
                            f"version {estimator.version}\nsensors true\n{offer}".encode())
    message_type, payload = connection.receive()
    if message_type != _HELLO:
        raise ConnectionError("the server did not send HELLO")
    wanted = {}
    for key, value in _lines(payload):
        if key == "parameter":
            name, _, wanted_value = value.partition(" ")
            wanted[name] = wanted_value
        elif key == "lockstep":
            estimator.lockstep = value == "true"
    connection.send(_PARAMETERS, _text_of(estimator.configure(wanted)))
    connection.send(_READY, struct.pack("<I", _HELLO))


def _serve(estimator, connection):
    sensors = None
    while True:
        message_type, payload = connection.receive()
        if message_type == _STOP:
            return
        if message_type == _FRAME:
            frame = _frame_from(payload, connection)
            if sensors:
                _add_samples(sensors, frame)
            sensors = None
            crc32 = zlib.crc32(frame.pixels)
            _send_answer(connection, frame, estimator.track(frame), crc32)
        elif message_type == _SENSORS:
            sensors = payload
        elif message_type == _CALIBRATION:
            estimator.calibrate(_calibration_from(payload, connection))
            connection.send(_READY, struct.pack("<I", _CALIBRATION))


def run(estimator, address=None):
    """Processes frames until the server sends stop; exits with code 1 after a failure.

    `address`: of the server; None = $OVERFLY_VO_ADDRESS.
    """
    sys.stdout.reconfigure(line_buffering=True)  # keep the last line before a crash
    address = address or os.environ.get("OVERFLY_VO_ADDRESS")
    if not address:
        sys.exit("OVERFLY_VO_ADDRESS is not set: this program is started by overfly")
    connection = estimator._connection = _Connection(address)
    try:
        _greet(estimator, connection)
        _serve(estimator, connection)
    except Exception as failure:
        try:
            estimator.log(ERROR, f"{type(failure).__name__}: {failure}")
        except OSError:
            pass  # the connection is closed: reported on stderr
        raise
