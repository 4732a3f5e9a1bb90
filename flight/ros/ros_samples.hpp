// Positions, attitudes and measurements of ROS topics until a flight has used them.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/earth/geodesy.hpp"
#include "core/sensors/sensor_tracks.hpp"
#include "flight/live/live_samples.hpp"
#include "flight/logs/ros/ros_topics.hpp"
#include "flight/ros/ros_flight.hpp"

namespace overfly::flight::ros_live {

/// Collects the samples of the topics of a flight by the same rules as a recording of them.
/// Times are those of the messages' headers. Not thread-safe.
class RosSamples final : private logs::LogSink {
 public:
  /// @param origin  of local positions
  RosSamples(const RosFlight& flight, const Geodetic& origin)
      : flight_(flight), local_(origin), topics_(*this) {}
  RosSamples(const RosSamples&) = delete;
  RosSamples& operator=(const RosSamples&) = delete;

  /// Takes a serialised message of a topic. Ignored after a clock has started again.
  /// @param type  as its publisher declares it
  void take(const std::string& topic, std::string_view type, std::span<const std::uint8_t> bytes);

  /// Heights are above the ellipsoid.
  [[nodiscard]] const std::deque<live::LivePosition>& positions() const { return positions_; }
  [[nodiscard]] const std::deque<live::LiveAttitude>& attitudes() const { return attitudes_; }
  /// What the vehicle's sensors measured. Stamps of a topic of sensors that start again are left
  /// out; they end no flight.
  [[nodiscard]] SensorTracks& sensors() { return sensors_; }
  [[nodiscard]] const SensorTracks& sensors() const { return sensors_; }
  /// Drops samples that are not needed from `t_ns` on.
  void forget_before(std::int64_t t_ns);

  /// The topic of positions or attitudes whose stamps started again; empty while none did.
  [[nodiscard]] const std::string& restarted() const { return restarted_; }
  /// live::kMaxLiveSamples are held.
  [[nodiscard]] bool full() const { return full_; }
  /// What is missing, for messages: "no Imu has come on /mavros/imu/data".
  [[nodiscard]] std::string missing_text() const;

 private:
  [[nodiscard]] bool stream(logs::StreamId id, const logs::StreamDescription& description) override;
  void message(logs::StreamId id, const std::optional<logs::LogTime>& time) override;
  void samples(logs::StreamId id,
               const logs::LogTime& time,
               int preference,
               const SensorSamples& samples) override;
  void local_origin(logs::StreamId /*id*/, const logs::LocalOrigin& /*origin*/) override {}
  void event(logs::LogEvent /*event*/) override {}
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
  /// Whether the flight has its positions or attitudes from a topic.
  [[nodiscard]] bool is_of_flight(const std::string& topic) const {
    return topic == flight_.position_topic() || topic == flight_.attitude_topic();
  }

  /// A topic with one type.
  struct Stream {
    std::string topic;
    logs::PositionKind position = logs::PositionKind::kNone;
    std::optional<std::uint32_t> boot;
  };

  RosFlight flight_;
  LocalFrame local_;
  logs::RosTopics topics_;
  std::deque<Stream> streams_;  ///< by StreamId
  std::deque<live::LivePosition> positions_;
  std::deque<live::LiveAttitude> attitudes_;
  SensorTracks sensors_{live::LiveSensors::kMaxWaiting};
  std::string other_type_;  ///< of a message on a topic of the flight that has no sample
  std::string restarted_;
  bool full_ = false;
  std::uint64_t invalid_ = 0;
};

}  // namespace overfly::flight::ros_live
