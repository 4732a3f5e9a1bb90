// Two sweeps flight by flight: the flights that both have, and conditions on them.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "server/experiments/comparison/condition.hpp"

namespace overfly::server::experiments {

/// The flights of two sweeps that have the same cell, repeat and estimator and were completed in
/// both.
struct PairedSweeps {
  FlightValues flights;   ///< of the first sweep, with "success_rate" as 0 or 1
  FlightValues baseline;  ///< of the second
  std::size_t pairs = 0;
  std::size_t without_pair = 0;  ///< flights that only one of the sweeps has completed
  std::size_t failed = 0;        ///< flights of either sweep that failed
};

/// Errors of positions and rotations are those of pairs with the outcome COMPLETED in both;
/// coverage and resets are those of all flights.
/// @param estimator  only its flights; all if empty
/// @param cancel  may be null
/// Without any flight that both have, the result has no pairs.
/// Errors: kNotFound for a folder that is no sweep, and for an estimator that one of them lacks; as
/// SweepResults::read; as read_run_metrics; kCancelled.
[[nodiscard]] Result<PairedSweeps> pair_sweeps(const std::filesystem::path& sweep,
                                               const std::filesystem::path& baseline,
                                               const std::string& estimator,
                                               evaluation::AlignmentMode mode,
                                               const std::atomic<bool>* cancel = nullptr);

/// For people, of sweeps without pairs.
inline constexpr const char* kNoPairs =
    "no flight was completed in both (same cell, repeat, seed and estimator)";

/// A condition and what became of it.
struct JudgedCondition {
  std::string text;
  Result<Condition::Verdict> verdict = Condition::Verdict{};
};

/// The conditions in their order. Errors: as Condition::parse, for the first that is invalid.
[[nodiscard]] Result<std::vector<JudgedCondition>> judged_conditions(
    const std::vector<std::string>& texts, const PairedSweeps& paired);

/// Test results in JUnit's XML: one case for each condition, which fails if the condition holds.
[[nodiscard]] std::string junit_from(const std::vector<JudgedCondition>& conditions);

}  // namespace overfly::server::experiments
