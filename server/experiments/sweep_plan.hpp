// Which flights of a sweep are due.
#pragma once

#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/experiments/sweep_document.hpp"
#include "server/experiments/sweep_results.hpp"

namespace overfly::server::experiments {

/// A flight that is due: one repeat of one cell, for the estimators without a result.
struct DueFlight {
  std::size_t cell = 0;  ///< index
  int repeat = 0;
  Scenario scenario;              ///< with these estimators only
  std::string key;                ///< of the flight and these estimators
  std::vector<std::string> keys;  ///< one per estimator of the scenario, as result_key
};

/// Whether a cell needs no further flight of an estimator.
/// @param successes, flights  of its repeats so far
[[nodiscard]] bool has_enough(const RepeatRule& rule, int successes, int flights);

/// Walks through the repeats of all cells: first all cells once, then all twice, ... Cells whose
/// repeats stop by themselves fly one at a time. What several cells or repeats have in common (the
/// seed of a repeat is also a value of an axis) is due once.
class SweepPlan {
 public:
  /// Resolves the first repeat of every cell, and the second one where it differs in more than the
  /// seed.
  /// Errors: as scenario_of, for all cells: each different message once, one a line, at most ten;
  /// kCancelled.
  [[nodiscard]] static Result<SweepPlan> make(const Sweep& sweep,
                                              std::vector<SweepCell> cells,
                                              const std::atomic<bool>* cancel = nullptr);

  /// The next flight that is due; empty if none is, or none before those flying are over, or once
  /// cancelled: passing over what is known may take long. Errors: as scenario_of.
  [[nodiscard]] Result<std::optional<DueFlight>> next(const SweepResults& results,
                                                      const std::atomic<bool>* cancel = nullptr);
  /// Whether other flights of the plan probably have the same pictures.
  [[nodiscard]] bool shares_pictures(const DueFlight& flight) const;
  /// A flight from next() is over: its results are known, or it is given up.
  void over(const DueFlight& flight);
  /// Results of flights for the other cells and repeats that have the same flight, as far as they
  /// are known and `results` lacks them. Each is returned once.
  [[nodiscard]] std::vector<SweepResult> take_shared(const SweepResults& results);
  /// Results of repeats that finished cells do not need: an earlier version of the estimator, or
  /// another seed, was flown more often before the rate was known.
  [[nodiscard]] std::vector<SweepResult> surplus(const SweepResults& results) const;

  [[nodiscard]] const std::vector<SweepCell>& cells() const { return cells_; }
  /// Flights of one estimator at most, of all cells together.
  [[nodiscard]] std::size_t most_flights() const;
  /// Flights that are over, or need not be flown.
  [[nodiscard]] std::size_t passed_flights() const;
  /// Names of the estimators, in the order of the first cell's scenario, then of the others.
  [[nodiscard]] const std::vector<std::string>& estimators() const { return estimators_; }
  /// Programs of estimators that are missing on this machine, in words. Workers on others may have
  /// them.
  [[nodiscard]] const std::vector<std::string>& absent_programs() const { return absent_programs_; }
  /// Results of one estimator in one cell as far as they are known, by repeat.
  [[nodiscard]] std::vector<const SweepResult*> results_of(std::size_t cell,
                                                           const std::string& estimator,
                                                           const SweepResults& results) const;

 private:
  struct State {
    int next_repeat = 0;
    int flying = 0;
    bool finished = false;
    std::string pictures;  ///< picture_key of the first repeat
    /// Estimator -> keys of its repeats, as far as they were reached.
    std::map<std::string, std::vector<std::string>> keys;
  };
  /// A repeat of a cell that has the result of another flight.
  struct Shared {
    std::size_t cell = 0;  ///< index
    int repeat = 0;
    std::string key;
  };
  SweepPlan(const Sweep& sweep, std::vector<SweepCell> cells)
      : sweep_(&sweep), cells_(std::move(cells)), states_(cells_.size()) {}
  void note_estimator(const EstimatorSpec& estimator);
  /// Empty if the repeat needs no flight.
  Result<std::optional<DueFlight>> flight_of(std::size_t cell, const SweepResults& results);
  [[nodiscard]] bool is_open(std::size_t cell,
                             const std::string& estimator,
                             const SweepResults& results) const;
  [[nodiscard]] bool is_flying(const std::string& key) const;
  /// Whether the last repeat of a cell is still flown, by itself or by another cell.
  [[nodiscard]] bool awaits_result(const State& state) const;
  /// The cell to be looked at next; empty if there is none now.
  [[nodiscard]] std::optional<std::size_t> next_cell() const;

  const Sweep* sweep_;
  std::vector<SweepCell> cells_;
  std::vector<State> states_;
  std::map<std::string, int> cells_with_pictures_;  ///< picture_key -> number of cells
  std::map<std::string, bool> flying_;  ///< key of a flight that was due -> it is not over
  std::vector<Shared> shared_;          ///< not returned by take_shared() yet
  std::vector<std::string> estimators_;
  std::vector<std::string> absent_programs_;
};

}  // namespace overfly::server::experiments
