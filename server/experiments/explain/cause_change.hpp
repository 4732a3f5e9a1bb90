// Takes causes out of a scenario's document, or makes them smaller.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/experiments/explain/cause.hpp"

namespace overfly::server::experiments {

/// A cause, and how much of it is left.
struct CauseChange {
  Cause cause = Cause::kFaults;
  /// Share that is left, in [0, 1); 0 for causes that cannot be scaled. The roll rate is multiplied
  /// by it.
  double share = 0.0;

  [[nodiscard]] bool operator==(const CauseChange&) const = default;
};

/// The change by which a cause is taken away: nothing is left of a disturbance; the roll rate is
/// halved.
[[nodiscard]] CauseChange without(Cause cause);

/// Why a cause cannot be changed in a flight ("there is none", "a recorded flight cannot roll
/// otherwise"); empty if it can.
/// @param document  of a scenario with defaults and exactly one estimator
[[nodiscard]] std::optional<std::string> why_unchangeable(const nlohmann::json& document,
                                                          Cause cause);

/// Whether the cause can be made smaller step by step.
[[nodiscard]] bool can_scale(const nlohmann::json& document, Cause cause);

/// @pre the cause can be changed, and scaled if the share is not that of without()
void change(nlohmann::json& document, const CauseChange& change);

/// How likely the cause seems before any flight, in [0, 1]: a fault that is active at the critical
/// instant is more likely than one long before.
/// @param instant_s  of the failure, from the start of the document's flight
[[nodiscard]] double suspicion(const nlohmann::json& document, Cause cause, double instant_s);

}  // namespace overfly::server::experiments
