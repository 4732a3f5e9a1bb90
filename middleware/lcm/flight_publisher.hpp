// Publishes a recorded flight on LCM channels: true poses and samples of sensors. Does not require
// LCM.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"

namespace overfly::lcm {

/// The channels are those of the first camera of an exported log.
inline constexpr const char* kFlightPrefix = "OVERFLY_";

class FlightPublisher {
 public:
  /// @param url  "udpm://...", "memq://", or "file://PATH?mode=w": an event log is written
  /// @param cancel  ends the test of the network; may be null
  /// Errors: kUnsupported if LCM is not built in; kInvalidArgument naming the part of the URL; kIo
  /// with a remedy if LCM cannot be opened; kCancelled.
  [[nodiscard]] static Result<std::unique_ptr<FlightPublisher>> open(
      const std::string& url, const std::atomic<bool>* cancel);
  virtual ~FlightPublisher() = default;

  /// Publishes a truth_t on OVERFLY_TRUTH. Errors: kIo naming the channel.
  [[nodiscard]] virtual Status publish_pose(std::int64_t frame,
                                            std::int64_t t_ns,
                                            const Pose& T_world_camera) = 0;
  /// Publishes the samples on OVERFLY_IMU, OVERFLY_GPS and so on, with sequence numbers from 1 on
  /// for each channel. Errors: kIo naming the channel.
  [[nodiscard]] virtual Status publish_samples(const SensorSamples& samples) = 0;
};

}  // namespace overfly::lcm
