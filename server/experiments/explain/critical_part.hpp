// The part of a flight in which its estimator failed.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::server::experiments {

/// Times from the start of the run [s].
struct CriticalPart {
  double from_s = 0.0;
  double to_s = 0.0;
  /// An estimator that has not initialised by then has not survived.
  double latest_start_s = 0.0;
};

/// Parts that may show the failure again, the shortest first; the last one begins with the flight.
/// A failure to initialise is a matter of the flight's beginning. Others need the time to
/// initialise before them, and a divergence, which is a change of scale over 10 s, more than that.
/// @param duration_s  of the flight
/// @pre the outcome is not kCompleted
[[nodiscard]] std::vector<CriticalPart> critical_parts(const evaluation::Score& score,
                                                       double duration_s);

/// Whether the failure of a run is a failure to initialise, or to do so in time.
[[nodiscard]] bool failed_to_start(evaluation::Outcome outcome);

/// Whether the estimator of a flight over `part` survived: its outcome is kCompleted, or it only
/// initialised later than such a short flight asks for.
[[nodiscard]] bool survived(const evaluation::Score& score, const CriticalPart& part);

/// The document that flies one part of a run with one of its estimators. Flights that cannot be
/// flown again from any instant (logs, live vehicles) become flights along the run's recorded
/// truth. Faults keep their place in the flight.
/// @param document  the run's scenario with its defaults
/// @param estimator  index in the document
[[nodiscard]] nlohmann::json part_document(const nlohmann::json& document,
                                           const std::filesystem::path& run_folder,
                                           std::size_t estimator,
                                           const CriticalPart& part);

}  // namespace overfly::server::experiments
