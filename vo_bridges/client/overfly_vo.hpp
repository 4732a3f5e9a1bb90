// Connects an estimator to Overfly's process door (docs/VO_PROTOCOL.md). A single header that can
// be copied into any project; C++17, standard library and POSIX:
//
//   struct Mine : overfly_vo::Estimator { ... };
//   int main() { return overfly_vo::run(Mine()); }
#pragma once

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <locale>
#include <map>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace overfly_vo {

/// Values by name: numbers as decimals with a point, flags as "true" or "false".
using Parameters = std::map<std::string, std::string>;

enum class State : std::uint32_t { kInitialising = 0, kTracking = 1, kLost = 2 };
enum class Level : std::uint32_t { kDebug = 0, kInfo = 1, kWarning = 2, kError = 3 };

struct Calibration {
  std::string camera;
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0, fy_px = 0.0, cx_px = 0.0, cy_px = 0.0;  ///< (0, 0) = centre of a pixel
  std::string distortion = "none";              ///< "none", "radtan", "equidistant", "fov"
  std::vector<double> distortion_coefficients;  ///< in the model's order
  double rate_hz = 0.0;                         ///< 0 = unknown
};

struct ImuSample {
  std::int64_t t_ns = 0;
  std::array<double, 3> acceleration_m_s2{};  ///< specific force, body axes (forward-right-down)
  std::array<double, 3> angular_rate_rad_s{};
};

struct BarometerSample {
  std::int64_t t_ns = 0;
  double pressure_pa = 0.0;  ///< static
  double temperature_k = 0.0;
};

struct GpsSample {
  std::int64_t t_ns = 0;          ///< when it was measured
  std::int64_t delivered_ns = 0;  ///< when the receiver sent it
  bool has_fix = false;           ///< false: all that follows is NaN
  double lat_deg = 0.0, lon_deg = 0.0, alt_ellipsoid_m = 0.0;
  std::array<double, 3> velocity_ned_m_s{};
  /// Standard deviations: along north and east, vertical, along each axis.
  double horizontal_accuracy_m = 0.0, vertical_accuracy_m = 0.0, speed_accuracy_m_s = 0.0;
};

struct AirspeedSample {
  std::int64_t t_ns = 0;
  double differential_pressure_pa = 0.0;
  double indicated_airspeed_m_s = 0.0;  ///< in air of 1.225 kg/m^3
};

struct MagnetometerSample {
  std::int64_t t_ns = 0;
  std::array<double, 3> field_ut{};  ///< body axes
};

struct RangeSample {
  std::int64_t t_ns = 0;
  double range_m = 0.0;  ///< to the ground along the body's z axis; infinity = no echo
};

struct Frame {
  std::int64_t index = 0;        ///< gaps are dropped frames
  std::int64_t t_ns = 0;         ///< mid exposure of the middle row
  std::int64_t exposure_ns = 0;  ///< 0 = unknown
  int width_px = 0;
  int height_px = 0;
  const std::uint8_t* pixels = nullptr;  ///< grey, without padding; valid during track()
  bool debug_wanted = false;             ///< return a debug image and map points
  /// Samples of the aircraft's sensors since the previous frame; empty without the sensor.
  std::vector<ImuSample> imu;
  std::vector<BarometerSample> barometer;
  std::vector<GpsSample> gps;
  std::vector<AirspeedSample> airspeed;
  std::vector<MagnetometerSample> magnetometer;
  std::vector<RangeSample> range;
};

struct DebugImage {
  int width_px = 0;  ///< width and height are at most the frame's
  int height_px = 0;
  int channels = 3;                  ///< 1 grey, 3 RGB
  std::vector<std::uint8_t> pixels;  ///< without padding; empty = no image
};

struct Answer {
  State state = State::kInitialising;
  std::uint32_t map_id = 0;  ///< +1 each time the estimator restarts by itself
  /// T_vo_camera, camera axes x right, y down, z forward. Valid only while tracking.
  std::array<double, 3> position{};
  std::array<double, 4> quaternion_xyzw{0.0, 0.0, 0.0, 1.0};
  double scene_depth = 0.0;                  ///< on the optical axis, or median; 0 = unknown
  std::map<std::string, double> counters{};  ///< names without spaces; only finite values
  std::map<std::string, double> timings_ms{};
  DebugImage debug_image{};  ///< only if debug_wanted
  std::vector<std::array<float, 3>>
      map_points{};  ///< only if debug_wanted; in the frame of position
  /// Covariance of the pose's error, row by row: 36 values of position x, y, z and small rotations
  /// about the fixed axes x, y, z of the frame of `position` [rad]; or the 9 of the position only.
  /// Empty = not stated.
  std::vector<double> covariance{};
};

/// The frame converted to RGB, to draw on.
inline DebugImage picture_of(const Frame& frame) {
  DebugImage picture{frame.width_px, frame.height_px, 3, {}};
  const auto width = static_cast<std::size_t>(frame.width_px);
  picture.pixels.resize(3 * width * static_cast<std::size_t>(frame.height_px));
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = frame.pixels[i / 3];
  return picture;
}

namespace detail {
class Connection;
class Greeting;
}  // namespace detail

/// An exception from any method is written to the run's log as an error and ends the session.
class Estimator {
 public:
  virtual ~Estimator() = default;
  virtual std::string name() const = 0;
  virtual std::string version() const { return "0"; }
  /// Receives the requested parameters and returns all parameters in effect. Called once, first.
  /// Throw for an unknown parameter: ignoring it would falsify an experiment. The default
  /// implementation accepts none.
  virtual Parameters configure(const Parameters& wanted) {
    if (!wanted.empty()) throw std::invalid_argument("unknown parameter " + wanted.begin()->first);
    return {};
  }
  /// Called before the first frame; again only if that frame is of another camera.
  virtual void calibrate(const Calibration& calibration) = 0;
  virtual Answer track(const Frame& frame) = 0;

 protected:
  /// Adds a line to the run's log; may be called from any thread while run() runs.
  void log(Level level, const std::string& line);
  /// Reports parameters read back from the running system, if configure() could not know them yet.
  void tell_parameters(const Parameters& effective);
  /// True if the server waits for each answer; false in real time. Valid from configure() on.
  bool lockstep() const { return lockstep_; }

 private:
  friend int run(Estimator& estimator, const char* address);
  friend class detail::Greeting;
  detail::Connection* connection_ = nullptr;
  bool lockstep_ = true;
};

/// Processes frames until the server sends stop. Returns the program's exit code: 0 after a stop, 1
/// after a failure (reported on stderr). `address`: of the server; null = $OVERFLY_VO_ADDRESS.
int run(Estimator& estimator, const char* address = nullptr);
inline int run(Estimator&& estimator) { return run(estimator); }

// Implementation.
namespace detail {

enum Type : std::uint16_t {
  kHello = 1,
  kReady = 2,
  kCalibration = 3,
  kFrame = 4,
  kAnswer = 5,
  kDebugImage = 6,
  kMapPoints = 7,
  kParameters = 8,
  kLog = 9,
  kStop = 11,
  kSensors = 12
};
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kPayloadLimitBytes = 65U << 20U;

/// Little-endian on every machine.
template <typename T>
void put(std::string* to, T value) {
  static_assert(sizeof(T) <= 8);
  std::uint64_t bits = 0;
  if constexpr (sizeof(T) == 4) {
    std::uint32_t half = 0;
    std::memcpy(&half, &value, 4);
    bits = half;
  } else if constexpr (sizeof(T) == 2) {
    bits = value;
  } else {
    std::memcpy(&bits, &value, 8);
  }
  for (std::size_t i = 0; i < sizeof(T); ++i) to->push_back(static_cast<char>(bits >> (8 * i)));
}

template <typename T>
T get(const std::string& from, std::size_t offset) {
  if (offset + sizeof(T) > from.size()) throw std::runtime_error("a message is too short");
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bits |= std::uint64_t{static_cast<unsigned char>(from[offset + i])} << (8 * i);
  }
  T value;
  if constexpr (sizeof(T) == 8) {
    std::memcpy(&value, &bits, 8);
  } else {
    value = static_cast<T>(bits);
  }
  return value;
}

inline std::string text_of(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << value;
  return text.str();
}

inline std::vector<double> numbers_from(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (double number = 0.0; in >> number;) numbers.push_back(number);
  return numbers;
}

inline double number_from(const std::string& text) {
  const std::vector<double> numbers = numbers_from(text);
  if (numbers.size() != 1) throw std::runtime_error("'" + text + "' is not a number");
  return numbers[0];
}

/// Splits "key value" lines.
inline std::vector<std::pair<std::string, std::string>> lines_of(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t space = line.find(' ');
    lines.emplace_back(line.substr(0, space),
                       space == std::string::npos ? "" : line.substr(space + 1));
  }
  return lines;
}

/// CRC-32 as in zlib, eight bytes at a time (Sarwate 1988).
inline std::uint32_t crc32_of(const std::uint8_t* bytes, std::size_t count) {
  static const auto tables = [] {
    std::array<std::array<std::uint32_t, 256>, 8> made{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      std::uint32_t rest = byte;
      for (int k = 0; k < 8; ++k) rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? 0xEDB88320U : 0U);
      made[0][byte] = rest;
    }
    for (std::size_t k = 1; k < 8; ++k) {
      for (std::size_t byte = 0; byte < 256; ++byte) {
        made[k][byte] = (made[k - 1][byte] >> 8U) ^ made[0][made[k - 1][byte] & 255U];
      }
    }
    return made;
  }();
  std::uint32_t rest = 0xFFFFFFFFU;
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      next ^= tables[7 - k][(bytes[i + k] ^ (rest >> (8 * k))) & 255U] ^
              tables[3 - k][bytes[i + 4 + k]];
    }
    rest = next;
  }
  for (; i < count; ++i) rest = (rest >> 8U) ^ tables[0][(rest ^ bytes[i]) & 255U];
  return ~rest;
}

struct Message {
  std::uint16_t type = 0;
  std::string payload;
};

class Connection {
 public:
  explicit Connection(const std::string& address) {
    if (address.rfind("unix:", 0) == 0) {
      connect_unix(address.substr(5));
    } else if (address.rfind("tcp:", 0) == 0) {
      connect_tcp(address.substr(4));
    } else {
      throw std::runtime_error("OVERFLY_VO_ADDRESS = '" + address +
                               "': must be unix:PATH or tcp:HOST:PORT");
    }
  }
  ~Connection() {
    if (memory_ != MAP_FAILED) ::munmap(memory_, memory_bytes_);
    if (memory_file_ >= 0) ::close(memory_file_);
    ::close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool local() const { return local_; }
  /// True on the first call only.
  bool first_not_finite() {
    const bool first = !not_finite_seen_;
    not_finite_seen_ = true;
    return first;
  }

  void send(Type type, const std::string& payload) {
    std::string bytes = "OVVO";
    put<std::uint16_t>(&bytes, 1);
    put<std::uint16_t>(&bytes, type);
    put<std::uint32_t>(&bytes, static_cast<std::uint32_t>(payload.size()));
    bytes += payload;
    const std::lock_guard<std::mutex> lock(sending_);
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw std::runtime_error("the server closed the connection");
      sent += static_cast<std::size_t>(n);
    }
  }

  Message receive() {
    const std::string header = receive_bytes(kHeaderBytes);
    if (header.compare(0, 4, "OVVO") != 0) throw std::runtime_error("not the OVVO protocol");
    const auto version = get<std::uint16_t>(header, 4);
    if (version != 1) {
      throw std::runtime_error("the server uses protocol version " + std::to_string(version) +
                               ": must be 1");
    }
    const auto length = get<std::uint32_t>(header, 8);
    if (length > kPayloadLimitBytes) throw std::runtime_error("a message is too long");
    return {get<std::uint16_t>(header, 6), receive_bytes(length)};
  }

  /// Maps the shared memory whose descriptor was received with the calibration.
  void map_frames(std::size_t slots, std::size_t slot_bytes) {
    if (memory_ != MAP_FAILED) ::munmap(memory_, memory_bytes_);
    slot_bytes_ = slot_bytes;
    memory_bytes_ = slots * slot_bytes;
    memory_ = ::mmap(nullptr, memory_bytes_, PROT_READ, MAP_SHARED, memory_file_, 0);
    if (memory_ == MAP_FAILED) throw std::runtime_error("cannot map the shared frames");
    ::close(memory_file_);
    memory_file_ = -1;
  }
  const std::uint8_t* slot(std::size_t number, std::size_t bytes) const {
    if (memory_ == MAP_FAILED || bytes > slot_bytes_ ||
        (number + 1) * slot_bytes_ > memory_bytes_) {
      throw std::runtime_error("a frame lies outside the shared memory");
    }
    return static_cast<const std::uint8_t*>(memory_) + number * slot_bytes_;
  }

 private:
  void connect_unix(const std::string& path) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    if (path.size() >= sizeof(name.sun_path)) throw std::runtime_error(path + " is too long");
    std::memcpy(name.sun_path, path.c_str(), path.size() + 1);
    socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) {
      throw std::runtime_error("cannot connect to " + path + ": " + std::strerror(errno));
    }
    local_ = true;
  }

  void connect_tcp(const std::string& host_port) {
    const std::size_t colon = host_port.rfind(':');
    if (colon == std::string::npos) throw std::runtime_error("tcp:" + host_port + ": no port");
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const std::string host = host_port.substr(0, colon);
    if (::getaddrinfo(host.c_str(), host_port.c_str() + colon + 1, &hints, &found) != 0) {
      throw std::runtime_error("cannot find " + host_port);
    }
    for (const addrinfo* at = found; at != nullptr && socket_ < 0; at = at->ai_next) {
      socket_ = ::socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC, at->ai_protocol);
      if (socket_ >= 0 && ::connect(socket_, at->ai_addr, at->ai_addrlen) != 0) {
        ::close(socket_);
        socket_ = -1;
      }
    }
    ::freeaddrinfo(found);
    if (socket_ < 0) throw std::runtime_error("cannot connect to " + host_port);
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  }

  /// Also receives a descriptor if one was sent.
  std::string receive_bytes(std::size_t count) {
    std::string bytes(count, '\0');
    for (std::size_t got = 0; got < count;) {
      iovec part{bytes.data() + got, count - got};
      alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
      msghdr message{};
      message.msg_iov = &part;
      message.msg_iovlen = 1;
      message.msg_control = control.data();
      message.msg_controllen = control.size();
      const ssize_t n = ::recvmsg(socket_, &message, MSG_CMSG_CLOEXEC);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw std::runtime_error("the server closed the connection");
      got += static_cast<std::size_t>(n);
      const cmsghdr* with = CMSG_FIRSTHDR(&message);
      if (with != nullptr && with->cmsg_type == SCM_RIGHTS) {
        if (memory_file_ >= 0) ::close(memory_file_);
        std::memcpy(&memory_file_, CMSG_DATA(with), sizeof(int));
      }
    }
    return bytes;
  }

  int socket_ = -1;
  bool local_ = false;
  bool not_finite_seen_ = false;
  std::mutex sending_;
  int memory_file_ = -1;
  void* memory_ = MAP_FAILED;
  std::size_t memory_bytes_ = 0;
  std::size_t slot_bytes_ = 0;
};

inline std::string text_of(const Parameters& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) {
    text.append(name).append(" ").append(value).append("\n");
  }
  return text;
}

inline void ready(Connection& connection, Type answered) {
  std::string payload;
  put<std::uint32_t>(&payload, answered);
  connection.send(kReady, payload);
}

inline Calibration calibration_from(const std::string& text, Connection& connection) {
  Calibration calibration;
  std::map<std::string, std::string> lines;
  for (const auto& [key, value] : lines_of(text)) lines[key] = value;
  calibration.camera = lines["camera"];
  calibration.width_px = static_cast<int>(number_from(lines["width_px"]));
  calibration.height_px = static_cast<int>(number_from(lines["height_px"]));
  calibration.fx_px = number_from(lines["fx_px"]);
  calibration.fy_px = number_from(lines["fy_px"]);
  calibration.cx_px = number_from(lines["cx_px"]);
  calibration.cy_px = number_from(lines["cy_px"]);
  calibration.distortion = lines["distortion"];
  calibration.distortion_coefficients = numbers_from(lines["distortion_coefficients"]);
  calibration.rate_hz = number_from(lines["rate_hz"]);
  if (lines.count("frame_slots") != 0) {
    connection.map_frames(static_cast<std::size_t>(number_from(lines["frame_slots"])),
                          static_cast<std::size_t>(number_from(lines["frame_slot_bytes"])));
  }
  return calibration;
}

inline Frame frame_from(const std::string& payload, const Connection& connection) {
  Frame frame;
  frame.index = get<std::int64_t>(payload, 0);
  frame.t_ns = get<std::int64_t>(payload, 8);
  frame.exposure_ns = get<std::int64_t>(payload, 16);
  frame.width_px = static_cast<int>(get<std::uint32_t>(payload, 24));
  frame.height_px = static_cast<int>(get<std::uint32_t>(payload, 28));
  const auto flags = get<std::uint32_t>(payload, 36);
  frame.debug_wanted = (flags & 1U) != 0;
  std::size_t at = 48;
  for (auto left = get<std::uint32_t>(payload, 44); left > 0; --left, at += 56) {
    ImuSample sample;
    sample.t_ns = get<std::int64_t>(payload, at);
    for (std::size_t k = 0; k < 3; ++k) {
      sample.acceleration_m_s2[k] = get<double>(payload, at + 8 + 8 * k);
      sample.angular_rate_rad_s[k] = get<double>(payload, at + 32 + 8 * k);
    }
    frame.imu.push_back(sample);
  }
  const std::size_t bytes =
      static_cast<std::size_t>(frame.width_px) * static_cast<std::size_t>(frame.height_px);
  if ((flags & 2U) != 0) {
    frame.pixels = connection.slot(get<std::uint32_t>(payload, 40), bytes);
  } else {
    if (payload.size() != at + bytes) throw std::runtime_error("a frame has the wrong length");
    frame.pixels = reinterpret_cast<const std::uint8_t*>(payload.data()) + at;
  }
  return frame;
}

/// Reads numbers of 8 bytes one after another.
class SampleReader {
 public:
  SampleReader(const std::string& payload, std::size_t at) : payload_(payload), at_(at) {}
  std::int64_t whole() { return get<std::int64_t>(payload_, next()); }
  double number() { return get<double>(payload_, next()); }
  /// Appends `count` samples, each read by `read`.
  template <typename Sample, typename Read>
  void list(std::uint32_t count, std::vector<Sample>* samples, Read read) {
    for (; count > 0; --count) {
      Sample sample;
      sample.t_ns = whole();
      read(&sample);
      samples->push_back(sample);
    }
  }

 private:
  std::size_t next() {
    const std::size_t at = at_;
    at_ += 8;
    return at;
  }
  const std::string& payload_;
  std::size_t at_;
};

/// Takes over the samples of a SENSORS message.
inline void add_samples(const std::string& payload, Frame* frame) {
  SampleReader reader(payload, 32);
  reader.list(get<std::uint32_t>(payload, 8), &frame->barometer, [&](BarometerSample* s) {
    s->pressure_pa = reader.number();
    s->temperature_k = reader.number();
  });
  reader.list(get<std::uint32_t>(payload, 12), &frame->gps, [&](GpsSample* s) {
    s->delivered_ns = reader.whole();
    s->has_fix = reader.whole() == 3;
    for (double* value : {&s->lat_deg, &s->lon_deg, &s->alt_ellipsoid_m}) *value = reader.number();
    for (double& value : s->velocity_ned_m_s) value = reader.number();
    s->horizontal_accuracy_m = reader.number();
    s->vertical_accuracy_m = reader.number();
    s->speed_accuracy_m_s = reader.number();
  });
  reader.list(get<std::uint32_t>(payload, 16), &frame->airspeed, [&](AirspeedSample* s) {
    s->differential_pressure_pa = reader.number();
    s->indicated_airspeed_m_s = reader.number();
  });
  reader.list(get<std::uint32_t>(payload, 20), &frame->magnetometer, [&](MagnetometerSample* s) {
    for (double& value : s->field_ut) value = reader.number();
  });
  reader.list(get<std::uint32_t>(payload, 24), &frame->range, [&](RangeSample* s) {
    s->range_m = reader.number();
  });
}

/// @param not_finite  set if a map point is left out because it is not finite
inline void send_debug(Connection& connection,
                       const Frame& frame,
                       const Answer& answer,
                       std::string* not_finite) {
  const DebugImage& image = answer.debug_image;
  if (!image.pixels.empty()) {
    std::string payload;
    put<std::int64_t>(&payload, frame.index);
    for (const int value : {image.width_px, image.height_px, image.channels, 0}) {
      put<std::uint32_t>(&payload, static_cast<std::uint32_t>(value));
    }
    payload.append(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size());
    connection.send(kDebugImage, payload);
  }
  if (!answer.map_points.empty()) {
    std::string points;
    std::uint32_t count = 0;
    for (const auto& point : answer.map_points) {
      if (!std::isfinite(point[0]) || !std::isfinite(point[1]) || !std::isfinite(point[2])) {
        *not_finite = "a map point";
        continue;
      }
      for (const float value : point) put<float>(&points, value);
      ++count;
    }
    std::string payload;
    put<std::int64_t>(&payload, frame.index);
    put<std::uint32_t>(&payload, count);
    put<std::uint32_t>(&payload, 0);
    connection.send(kMapPoints, payload + points);
  }
}

/// "KEY NAME VALUE" lines of the finite values; `not_finite`: the first invalid one, "KEY NAME".
inline std::string figures_text(const std::string& key,
                                const std::map<std::string, double>& figures,
                                std::string* not_finite) {
  std::string text;
  for (const auto& [name, value] : figures) {
    if (std::isfinite(value)) {
      text += key + " " + name + " " + text_of(value) + "\n";
    } else if (not_finite->empty()) {
      *not_finite = key + " " + name;
    }
  }
  return text;
}

inline std::string payload_of(const Answer& answer,
                              std::int64_t index,
                              std::uint32_t crc32,
                              std::string* not_finite) {
  std::string payload;
  put<std::int64_t>(&payload, index);
  put<std::uint32_t>(&payload, static_cast<std::uint32_t>(answer.state));
  put<std::uint32_t>(&payload, answer.map_id);
  for (const double value : answer.position) put<double>(&payload, value);
  for (const double value : answer.quaternion_xyzw) put<double>(&payload, value);
  put<double>(&payload, answer.scene_depth);
  put<std::uint32_t>(&payload, crc32);
  put<std::uint32_t>(&payload, 1);  // the CRC was computed
  payload += figures_text("counter", answer.counters, not_finite);
  payload += figures_text("timing_ms", answer.timings_ms, not_finite);
  if (!answer.covariance.empty()) {
    payload += "covariance";
    for (const double value : answer.covariance) payload += " " + text_of(value);
    payload += "\n";
  }
  return payload;
}

inline void log_line(Connection& connection, Level level, const std::string& line) {
  std::string payload;
  put<std::uint32_t>(&payload, static_cast<std::uint32_t>(level));
  connection.send(kLog, payload + line.substr(0, 4096));
}

/// @param sensors  payload of the SENSORS message before this frame; empty = none
inline void answer_frame(Estimator& estimator,
                         Connection& connection,
                         const std::string& payload,
                         const std::string& sensors) {
  Frame frame = frame_from(payload, connection);
  if (!sensors.empty()) add_samples(sensors, &frame);
  const std::uint32_t crc32 = crc32_of(
      frame.pixels,
      static_cast<std::size_t>(frame.width_px) * static_cast<std::size_t>(frame.height_px));
  const Answer answer = estimator.track(frame);
  std::string not_finite;
  if (frame.debug_wanted) send_debug(connection, frame, answer, &not_finite);
  const std::string answered = payload_of(answer, frame.index, crc32, &not_finite);
  if (!not_finite.empty() && connection.first_not_finite()) {
    log_line(connection,
             Level::kWarning,
             not_finite + " is not finite: this and later such values are ignored");
  }
  connection.send(kAnswer, answered);
}

class Greeting {
 public:
  static void set_lockstep(Estimator* estimator, bool lockstep) { estimator->lockstep_ = lockstep; }
};

inline void greet(Estimator& estimator, Connection& connection) {
  std::string own = "protocol 1\nname ";
  own.append(estimator.name()).append("\nversion ").append(estimator.version()).append("\n");
  own += "sensors true\n";
  if (connection.local()) own += "shared_memory true\n";
  connection.send(kHello, own);
  const Message hello = connection.receive();
  if (hello.type != kHello) throw std::runtime_error("the server did not send HELLO");
  Parameters wanted;
  for (const auto& [key, value] : lines_of(hello.payload)) {
    if (key == "lockstep") Greeting::set_lockstep(&estimator, value == "true");
    if (key != "parameter") continue;
    for (const auto& [name, text] : lines_of(value)) wanted[name] = text;
  }
  connection.send(kParameters, text_of(estimator.configure(wanted)));
  ready(connection, kHello);
}

inline void serve(Estimator& estimator, Connection& connection) {
  std::string sensors;
  for (;;) {
    Message message = connection.receive();
    if (message.type == kStop) return;
    if (message.type == kFrame) {
      answer_frame(estimator, connection, message.payload, sensors);
      sensors.clear();
    } else if (message.type == kSensors) {
      sensors = std::move(message.payload);
    } else if (message.type == kCalibration) {
      estimator.calibrate(calibration_from(message.payload, connection));
      ready(connection, kCalibration);
    }
  }
}

}  // namespace detail

inline void Estimator::log(Level level, const std::string& line) {
  if (connection_ != nullptr) detail::log_line(*connection_, level, line);
}

inline void Estimator::tell_parameters(const Parameters& effective) {
  if (connection_ != nullptr) {
    connection_->send(detail::kParameters, detail::text_of(effective));
  }
}

inline int run(Estimator& estimator, const char* address) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // keep the last line before a crash
  if (address == nullptr) address = std::getenv("OVERFLY_VO_ADDRESS");
  if (address == nullptr) {
    std::fprintf(stderr, "OVERFLY_VO_ADDRESS is not set: this program is started by overfly\n");
    return 1;
  }
  try {
    detail::Connection connection(address);
    estimator.connection_ = &connection;
    try {
      detail::greet(estimator, connection);
      detail::serve(estimator, connection);
    } catch (const std::exception& failure) {
      std::fprintf(stderr, "%s: %s\n", estimator.name().c_str(), failure.what());
      try {
        detail::log_line(connection, Level::kError, failure.what());
      } catch (const std::exception&) {  // the connection is closed: reported on stderr
      }
      estimator.connection_ = nullptr;
      return 1;
    }
    estimator.connection_ = nullptr;
    return 0;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
}

}  // namespace overfly_vo
