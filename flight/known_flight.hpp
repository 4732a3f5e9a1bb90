// A flight that is known from its start to its end before it is flown. Private to flight and its
// sub-rooms.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/motion/truth_source.hpp"

namespace overfly::flight {

class KnownFlight : public TruthSource {
 public:
  explicit KnownFlight(std::string description, std::vector<std::string> warnings = {})
      : description_(std::move(description)), warnings_(std::move(warnings)) {}

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const final { return end_ns(); }
  [[nodiscard]] std::string description() const final { return description_; }
  [[nodiscard]] std::vector<std::string> warnings() const final { return warnings_; }

 private:
  /// The last instant of the flight, counted from its start.
  [[nodiscard]] virtual std::int64_t end_ns() const = 0;
  /// @param t_ns  within [0, end_ns()]
  [[nodiscard]] virtual AircraftState state(std::int64_t t_ns) const = 0;

  /// Errors: kInvalidArgument for a time before the flight.
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* /*cancel*/) final {
    if (t_ns < 0) {
      return Error{ErrorCode::kInvalidArgument,
                   "t_ns = " + std::to_string(t_ns) + ": the flight spans [0, " +
                       std::to_string(end_ns()) + "] ns"};
    }
    if (t_ns > end_ns()) return std::optional<AircraftState>();
    return std::optional(state(t_ns));
  }

  std::string description_;
  std::vector<std::string> warnings_;
};

}  // namespace overfly::flight
