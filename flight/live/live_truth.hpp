// The flight of a live vehicle as a source of truth.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "core/sensors/sample_source.hpp"
#include "flight/live/live_options.hpp"
#include "flight/mavlink/feedback/feedback_sender.hpp"
#include "flight/mavlink/vehicle/vehicle.hpp"

namespace overfly::flight::live {

/// Flies what a vehicle reports. Time is the vehicle's clock and counts from the first instant with
/// a position and an attitude, or from the start condition, so that simulations at any speed-up
/// give the same flight; the time of arrival is not used. Positions are interpolated by cubic
/// Hermite polynomials of the reported velocities, attitudes by SLERP.
///
/// state_at() waits until the vehicle's clock has passed the time. The flight ends at the last
/// sample when the vehicle restarts or a stop condition holds; warnings() says why. A vehicle that
/// restarts before its flight has started is waited for again, with a warning. It fails
/// (kIo, with what was heard last) after `patience` without a sample.
class LiveTruth final : public TruthSource, public SampleSource {
 public:
  /// Listens to the vehicle and waits for the flight's start. No other listener may be set until
  /// the object goes.
  /// @param cancel  ends the wait; may be null
  /// Errors: kIo after `patience`, with what is missing, and if the flight ends before its start
  /// condition holds; kCancelled.
  static Result<std::unique_ptr<LiveTruth>> open(std::shared_ptr<mavlink::Vehicle> vehicle,
                                                 const LocalFrame& frame,
                                                 const LiveTruthOptions& options,
                                                 const std::atomic<bool>* cancel);
  ~LiveTruth() override;

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override { return std::nullopt; }
  /// "live vehicle 1.1 on udp-listen:...: the simulator's state (1.1/SIM_STATE)".
  [[nodiscard]] std::string description() const override;
  /// Gaps so far, and why the flight has ended.
  [[nodiscard]] std::vector<std::string> warnings() const override;
  /// Modes, mission items, arming and texts of the vehicle.
  [[nodiscard]] std::vector<FlightEvent> take_events(std::int64_t t_ns) override;
  [[nodiscard]] std::optional<VehicleStatus> take_status(std::int64_t t_ns) override;
  /// What the vehicle's own sensors measured: see LiveSensors.
  [[nodiscard]] SampleSource* sample_source() override { return this; }
  [[nodiscard]] SensorSamples take_samples(std::int64_t t_ns) override;
  [[nodiscard]] std::string sensor_report() const override;

  /// Sends estimates to the vehicle by this from now on.
  void send_estimates_by(std::shared_ptr<mavlink::FeedbackSender> sender);
  void begin() override;
  [[nodiscard]] std::shared_ptr<EstimateReceiver> estimate_receiver() const override;
  [[nodiscard]] std::optional<std::int64_t> heard_ns() const override;

  /// The vehicle's clock at t = 0 [ns].
  [[nodiscard]] std::int64_t start_ns() const;

 private:
  struct Impl;
  explicit LiveTruth(std::unique_ptr<Impl> impl);
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) override;
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::flight::live
