// Sends estimates to a vehicle.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/earth/geodesy.hpp"
#include "core/motion/estimate_receiver.hpp"
#include "core/result.hpp"
#include "flight/mavlink/feedback/feedback_options.hpp"
#include "flight/mavlink/feedback/feedback_queue.hpp"
#include "flight/mavlink/feedback/feedback_track.hpp"
#include "flight/mavlink/vehicle/vehicle.hpp"

namespace overfly::flight::mavlink {

/// What was sent, and why not more.
struct FeedbackCounts {
  std::uint64_t sent = 0;
  std::uint64_t by_timesync = 0;  ///< of these, sent at a time of TIMESYNC
  std::uint64_t unplaced = 0;     ///< answers without a pose in the world
  std::uint64_t unknown = 0;      ///< the vehicle's origin or height was not known
  std::uint64_t unsent = 0;       ///< the link took no more
  std::uint64_t waiting = 0;      ///< their latency had not passed at the end
  std::int64_t oldest_sent_ns = 0;
};

/// Sends each estimate when its latency has passed by the vehicle's clock, on a thread of its own.
/// Stamps are the capture's time of the vehicle's clock, in which the vehicle reported the pose
/// that the camera saw: they need no conversion. TIMESYNC only says how late it is now.
class FeedbackSender final : public EstimateReceiver {
 public:
  /// @param frame     the world's
  /// @param start_ns  the vehicle's clock at the flight's t = 0
  FeedbackSender(std::shared_ptr<Vehicle> vehicle,
                 const FeedbackOptions& options,
                 const LocalFrame& frame,
                 double geoid_separation_m,
                 std::int64_t start_ns);
  ~FeedbackSender() override;
  FeedbackSender(const FeedbackSender&) = delete;
  FeedbackSender& operator=(const FeedbackSender&) = delete;

  /// Replaces start_ns, before the first estimate.
  void start_at(std::int64_t start_ns);
  void take(const PlacedEstimate& estimate) override;
  /// Estimates whose latency has not passed are not sent any more, but counted.
  void finish() override;
  /// "sent 930 ODOMETRY to vehicle 1.1, ...".
  [[nodiscard]] std::string report() const override;
  [[nodiscard]] FeedbackCounts counts() const;

 private:
  void run();
  void send(const FeedbackSample& sample, const VehicleNow& now, const VehicleState& state);

  const std::shared_ptr<Vehicle> vehicle_;
  const FeedbackOptions options_;
  const LocalFrame frame_;
  const double geoid_separation_m_;

  mutable std::mutex mutex_;
  std::int64_t start_ns_;
  std::condition_variable news_;
  FeedbackTrack track_;
  FeedbackQueue queue_;
  FeedbackCounts counts_;
  bool stops_ = false;
  std::string failure_;  ///< of the thread; empty: none
  std::thread thread_;
};

}  // namespace overfly::flight::mavlink
