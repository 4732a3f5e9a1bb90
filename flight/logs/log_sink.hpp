// What a reader of flight logs reports, and to whom.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

#include "core/motion/flight_event.hpp"
#include "core/motion/pose.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "flight/logs/local_grid.hpp"

namespace overfly::flight::logs {

/// Number of a stream in the order in which the streams of a log are met, from 0.
using StreamId = std::uint32_t;

/// Where a position or attitude comes from, the most trusted first.
enum class SourceOrigin {
  kSimulation,  ///< the simulator's own state
  kEstimate,    ///< the autopilot's estimator
  kGps,         ///< a receiver, unfiltered
  kNone,
};
[[nodiscard]] const char* to_string(SourceOrigin origin);

enum class PositionKind {
  kNone,
  kGeodetic,  ///< latitude, longitude [deg], height [m] above the stream's HeightDatum
  kLocal,     ///< north, east, down from the stream's origin [m]
};

/// What the heights of geodetic positions count from.
enum class HeightDatum {
  kMeanSeaLevel,
  kEllipsoid,  ///< of WGS84
};

/// The messages of one kind from one sender.
struct StreamDescription {
  std::string name;     ///< unique in the log: "XKF1[0]", "1.1/ATTITUDE"
  std::string vehicle;  ///< the sender whose clock stamps the stream; "" if the log has only one
  PositionKind position = PositionKind::kNone;
  HeightDatum height = HeightDatum::kMeanSeaLevel;
  bool attitude = false;
  bool imu = false;
  bool sensors = false;  ///< its messages may hold samples of sensors
  SourceOrigin origin = SourceOrigin::kNone;
  int preference = 0;  ///< among sources of one origin, the smaller the better
};

/// A time of a vehicle's clock, which counts from its start.
struct LogTime {
  std::uint32_t boot = 0;  ///< the clock's restarts so far
  std::int64_t t_ns = 0;
  friend bool operator==(const LogTime&, const LogTime&) = default;
};

enum class EventKind { kMode, kArming, kMission, kCamera, kText, kOther };
[[nodiscard]] const char* to_string(EventKind kind);

struct LogEvent {
  std::string vehicle;
  std::optional<LogTime> time;  ///< empty if the log has no time for it
  EventKind kind = EventKind::kOther;
  std::string text;
};

/// What an event of a log is to a flight: modes and mission items only by their names. Empty for
/// what a flight does not report: camera triggers.
[[nodiscard]] std::optional<FlightEvent> flight_event_of(EventKind kind, const std::string& text);

/// A position or an attitude that cannot be right: one of them is set.
struct WrongValue {
  std::optional<Eigen::Vector3d> position{};  ///< as the stream's PositionKind
  std::optional<double> quaternion_norm{};
  std::optional<RollPitchYaw> angles{};
};

/// Receives what a reader finds, in the order of the file.
///
/// Samples that cannot be right are left out and counted: see position() and attitude().
class LogSink {
 public:
  virtual ~LogSink() = default;

  /// A stream is met for the first time. @return whether its positions, attitudes and samples of
  /// sensors are wanted
  [[nodiscard]] virtual bool stream(StreamId id, const StreamDescription& description) = 0;
  /// A message of a stream; `time` is empty if its time is unknown.
  virtual void message(StreamId id, const std::optional<LogTime>& time) = 0;
  /// @param value  as the stream's PositionKind. Left out: values that are not finite or outside of
  /// their ranges, and latitude and longitude 0, which stand for no fix
  void position(StreamId id, const LogTime& time, const Eigen::Vector3d& value);
  /// @param R_ned_body  need not be normalised. Left out: values that are not finite, and norms
  /// that are not within 10 % of 1
  void attitude(StreamId id, const LogTime& time, const Eigen::Quaterniond& R_ned_body);
  /// Samples of sensors in a message; their times are those of the clock of `time`.
  /// Without any, the message had none that can be right.
  /// @param preference  of several streams with samples of one sensor the lowest is the best
  virtual void samples(StreamId /*id*/,
                       const LogTime& /*time*/,
                       int /*preference*/,
                       const SensorSamples& /*samples*/) {}
  /// A sample that its sender marks as invalid, e.g. without a fix.
  void no_sample(StreamId id) { take_invalid(id); }
  /// A value that cannot be right.
  void wrong_value(StreamId id, const LogTime& time, const WrongValue& value) {
    take_wrong_value(id, time, value);
    take_invalid(id);
  }
  /// Where a stream's local positions count from, until the next origin of that stream.
  virtual void local_origin(StreamId id, const LocalOrigin& origin) = 0;
  /// Something was read that is needed to understand what follows: a format, a name, a state.
  virtual void declaration() {}
  virtual void event(LogEvent event) = 0;
  /// Something that was left out, or looks wrong: a sentence with a count.
  virtual void warning(const std::string& text) = 0;
  /// Something about the whole recording that it does not state and that is taken for granted.
  virtual void assumption(const std::string& text) { warning(text); }
  /// The number of bytes read so far. @return false to stop reading
  [[nodiscard]] virtual bool progress(std::uint64_t bytes) = 0;

 private:
  virtual void take_position(StreamId id, const LogTime& time, const Eigen::Vector3d& value) = 0;
  virtual void take_attitude(StreamId id,
                             const LogTime& time,
                             const Eigen::Quaterniond& R_ned_body) = 0;
  virtual void take_invalid(StreamId id) = 0;
  /// What is wrong with the sample of the take_invalid() that follows.
  virtual void take_wrong_value(StreamId /*id*/,
                                const LogTime& /*time*/,
                                const WrongValue& /*value*/) {}
  /// @return how the stream's positions are given
  [[nodiscard]] virtual PositionKind position_kind(StreamId id) const = 0;
};

}  // namespace overfly::flight::logs
