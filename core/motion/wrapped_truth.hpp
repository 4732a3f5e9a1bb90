// A flight that passes on another one, for those that watch it while it flies.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/motion/truth_source.hpp"

namespace overfly {

/// Passes on everything but the states. A subclass may add events and
/// sensors.
class WrappedTruth : public TruthSource {
 public:
  explicit WrappedTruth(std::unique_ptr<TruthSource> flight) : flight_(std::move(flight)) {}

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const final {
    return flight_->duration_ns();
  }
  [[nodiscard]] std::string description() const final { return flight_->description(); }
  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const final {
    return flight_->log_start_ns();
  }
  [[nodiscard]] std::vector<std::string> warnings() const final { return flight_->warnings(); }
  void begin() final { flight_->begin(); }
  [[nodiscard]] std::vector<FlightEvent> take_events(std::int64_t t_ns) override {
    return flight_->take_events(t_ns);
  }
  [[nodiscard]] std::optional<VehicleStatus> take_status(std::int64_t t_ns) final {
    return flight_->take_status(t_ns);
  }
  [[nodiscard]] SampleSource* sample_source() override { return flight_->sample_source(); }
  [[nodiscard]] std::shared_ptr<EstimateReceiver> estimate_receiver() const final {
    return flight_->estimate_receiver();
  }
  [[nodiscard]] std::optional<std::int64_t> heard_ns() const final { return flight_->heard_ns(); }

 protected:
  [[nodiscard]] TruthSource& flight() { return *flight_; }

 private:
  std::unique_ptr<TruthSource> flight_;
};

}  // namespace overfly
