// Playbacks of flights onto LCM channels and ROS 1 topics.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "flight/playback/playback_output.hpp"
#include "flight/playback/topics/flight_moments.hpp"

namespace overfly::flight::playback {

/// Publishes truth_t on OVERFLY_TRUTH (a camera that looks down from the aircraft, top of the image
/// to the nose; world: the map), gps_t on OVERFLY_GPS and imu_t on OVERFLY_IMU at each moment.
/// Times count from the flight's start. Nobody can be heard: it begins at once.
/// open() has the errors of lcm::FlightPublisher::open.
[[nodiscard]] std::unique_ptr<PlaybackOutput> lcm_output(FlightMoments moments,
                                                         const std::string& url);

struct RosTarget {
  std::string master_uri = "http://127.0.0.1:11311";
  std::string node_name = "overfly_play";
  std::chrono::milliseconds patience{10000};  ///< for the master's answer
};

/// Publishes on the topics of MAVROS at each moment (ros1::FlightPublisher), and the vehicle's
/// state each second: armed, and disarmed at the end. Stamps count from FlightMoments::epoch_ns().
/// Begins a second after somebody listens, so that all topics of a listener are connected.
/// open() has the errors of ros1::FlightPublisher::open.
[[nodiscard]] std::unique_ptr<PlaybackOutput> ros_output(FlightMoments moments, RosTarget target);

}  // namespace overfly::flight::playback
