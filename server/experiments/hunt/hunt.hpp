// Searches the worst flight of an estimator within limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/fly_sweep.hpp"
#include "server/experiments/hunt/hunt_document.hpp"

namespace overfly::server::experiments {

struct HuntedFlight {
  SweepCell cell;
  int repeat = 0;
  std::uint64_t seed = 0;  ///< of the scenario
  std::string run;         ///< its folder, relative to the hunt's
  evaluation::Outcome outcome = evaluation::Outcome::kNotInitialised;
  SurvivalMargin margin;
};

struct HuntResult {
  std::vector<HuntedFlight> flights;  ///< in the order of the search
  bool exhausted = false;             ///< every point of the axes was flown
  bool cancelled = false;

  /// The flight with the lowest margin, the first of several; null before the first flight.
  [[nodiscard]] const HuntedFlight* worst() const;
  /// Number of flights up to the first failure; empty if none failed.
  [[nodiscard]] std::optional<std::size_t> flights_to_failure() const;
};

struct HuntOptions {
  SweepOptions flights;
  /// Told before and after each flight or batch.
  std::function<void(const HuntResult&)> progress;
};

/// Flies one point after the other, as PointSearch proposes them for the margins of the points
/// before, until a flight fails or Hunt::most_flights have flown. The value of a point is the
/// lowest margin of its repeats. Flights are kept as those of a sweep: a hunt that was cancelled or
/// killed is continued by the next call, which flies nothing twice.
/// Errors: as fly_cells and read_evidence; kInternal for a flight that could not be flown.
[[nodiscard]] Result<HuntResult> fly_hunt(const Hunt& hunt, const HuntOptions& options);

/// "fails: LOST at 12.3 s", "survives with margin 0.31"
[[nodiscard]] std::string result_text(const HuntedFlight& flight);

/// The scenario of a flight of the hunt, complete by itself. Errors: as scenario_of.
[[nodiscard]] Result<nlohmann::json> scenario_document(const Hunt& hunt,
                                                       const HuntedFlight& flight);

}  // namespace overfly::server::experiments
