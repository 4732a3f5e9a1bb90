// Samples of a live vehicle by its own clock, until a flight has used them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "flight/live/live_sensors.hpp"
#include "flight/logs/log_sink.hpp"
#include "flight/logs/tlog/frame_streams.hpp"
#include "flight/mavlink/frame.hpp"

namespace overfly::flight::live {

/// Samples of one kind that are kept: 80 minutes at 100 Hz.
inline constexpr std::size_t kMaxLiveSamples = 500'000;
/// Events that wait to be taken. A vehicle may send any number: of more, the oldest texts and other
/// instants are dropped first, then the oldest modes and items.
inline constexpr std::size_t kMaxLiveEvents = 1000;

struct LivePosition {
  std::int64_t t_ns = 0;      ///< the vehicle's clock
  Eigen::Vector3d geodetic;   ///< latitude, longitude [deg], height above mean sea level [m]
  Eigen::Vector3d v_ned_m_s;  ///< zero if the message has none
  bool has_velocity = false;
  double indicated_airspeed_m_s = -1.0;  ///< the latest at that time; negative: unknown
};

struct LiveAttitude {
  std::int64_t t_ns = 0;
  Eigen::Quaterniond R_ned_body;  ///< unit
  Eigen::Vector3d rate_rad_s;     ///< about the body's axes
  bool has_rate = false;
};

/// The positions and attitudes of one kind of message.
struct LiveStream {
  logs::StreamDescription description;
  std::deque<LivePosition> positions;  ///< times strictly increasing
  std::deque<LiveAttitude> attitudes;
  std::optional<logs::LocalOrigin> origin;  ///< of local positions
  std::uint64_t without_origin = 0;         ///< local positions left out
};

/// What looks wrong in the samples of the streams that are flown, from the flight's start on.
struct LiveDoubts {
  std::uint64_t jumps = 0;  ///< steps between positions as logs::jump_between_m()
  double largest_jump_m = 0.0;
  std::int64_t largest_jump_ns = 0;  ///< the vehicle's clock behind it
  /// Samples left out: earlier than the one before them, and their time was known already or the
  /// flight had passed it.
  std::uint64_t backward = 0;
  std::int64_t furthest_back_ns = 0;     ///< of these, before the latest time
  std::int64_t furthest_back_at_ns = 0;  ///< that latest time
};

/// Collects the samples of one vehicle by the same rules as a recording of it. Messages that come
/// late are put in order; times that are known already are left out. Messages are held until the
/// vehicle's clock is proven (HeldMessages): first stamps that are wrong begin no flight. Not
/// thread-safe.
class LiveSamples final : private logs::LogSink {
 public:
  /// @param geoid_separation_m  added to the heights of the vehicle's GPS
  /// @param autopilot  as LiveSensors
  explicit LiveSamples(double geoid_separation_m, std::uint8_t autopilot = 0)
      : streams_of_frames_(*this), sensors_(geoid_separation_m, autopilot) {}
  LiveSamples(const LiveSamples&) = delete;
  LiveSamples& operator=(const LiveSamples&) = delete;

  /// Takes a message. Ignored after the vehicle's clock has started again.
  void take(const mavlink::Frame& frame);

  [[nodiscard]] const std::deque<LiveStream>& streams() const { return streams_; }
  /// Keeps samples of these streams only.
  void keep_only(logs::StreamId position, logs::StreamId attitude);
  /// Drops samples that are not needed from `t_ns` on.
  void forget_before(std::int64_t t_ns);
  /// The flight starts at `t_ns`: drops samples and doubts from before it.
  void start_at(std::int64_t t_ns);
  [[nodiscard]] const LiveDoubts& doubts() const { return doubts_; }

  /// The first time of the vehicle's clock; empty before it.
  [[nodiscard]] std::optional<std::int64_t> first_ns() const { return first_ns_; }
  /// The latest time of the vehicle's clock; empty before the first.
  [[nodiscard]] std::optional<std::int64_t> latest_ns() const { return latest_ns_; }
  [[nodiscard]] bool restarted() const { return restarted_; }
  /// A stream has reached kMaxLiveSamples. From then on it takes no samples, also after others were
  /// forgotten: there would be holes between them.
  [[nodiscard]] bool full() const { return full_; }
  [[nodiscard]] std::uint64_t invalid() const { return invalid_; }
  /// Events that were not taken yet, with times of the vehicle's clock; at most kMaxLiveEvents.
  [[nodiscard]] std::deque<FlightEvent>& events() { return events_; }
  /// Events that were dropped.
  [[nodiscard]] std::uint64_t lost_events() const { return lost_events_; }
  [[nodiscard]] LiveSensors& sensors() { return sensors_; }

 private:
  [[nodiscard]] bool stream(logs::StreamId id, const logs::StreamDescription& description) override;
  void message(logs::StreamId id, const std::optional<logs::LogTime>& time) override;
  void local_origin(logs::StreamId id, const logs::LocalOrigin& origin) override;
  void event(logs::LogEvent event) override;
  void warning(const std::string& /*text*/) override {}
  [[nodiscard]] bool progress(std::uint64_t /*bytes*/) override { return true; }
  void take_position(logs::StreamId id,
                     const logs::LogTime& time,
                     const Eigen::Vector3d& value) override;
  void take_attitude(logs::StreamId id,
                     const logs::LogTime& time,
                     const Eigen::Quaterniond& R_ned_body) override;
  void take_invalid(logs::StreamId /*id*/) override { ++invalid_; }
  [[nodiscard]] logs::PositionKind position_kind(logs::StreamId id) const override;
  template <typename Sample>
  void insert_by_time(std::deque<Sample>& samples, const Sample& sample);
  void count_jump(const LivePosition& from, const LivePosition& to);

  logs::FrameStreams streams_of_frames_;
  std::deque<LiveStream> streams_;  ///< by StreamId
  std::optional<logs::StreamId> position_;
  std::optional<logs::StreamId> attitude_;
  std::int64_t forgotten_ns_ = std::numeric_limits<std::int64_t>::min();
  LiveDoubts doubts_;
  std::optional<std::uint32_t> boot_;
  std::optional<std::int64_t> first_ns_;
  std::optional<std::int64_t> latest_ns_;
  double indicated_airspeed_m_s_ = -1.0;
  bool restarted_ = false;
  bool full_ = false;
  std::uint64_t invalid_ = 0;
  std::deque<FlightEvent> events_;
  std::uint64_t lost_events_ = 0;
  LiveSensors sensors_;
};

}  // namespace overfly::flight::live
