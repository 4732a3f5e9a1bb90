// Flies changed parts of a run as processes, and keeps their results.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <list>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "server/experiments/explain/explanation.hpp"
#include "server/experiments/flights/flight_process.hpp"
#include "server/experiments/pictures/flight_frame_cache.hpp"

namespace overfly::server::experiments {

struct ReflightOptions {
  std::filesystem::path folder;             ///< of the explanation; created
  std::filesystem::path program;            ///< this program, which flies single scenarios
  std::vector<std::string> flight_options;  ///< further options of `overfly run`
  std::size_t jobs = 1;                     ///< flights at the same time, if the memory suffices
  std::size_t most_flights = 12;
  double timeout_s = 3600.0;  ///< of one flight, on the clock on the wall
  SourcePolicy sources;
  FlightFrameCache frame_cache;
  const std::atomic<bool>* cancel = nullptr;
  /// Told before and after each flight: how many are done, and what is flown.
  std::function<void(std::size_t done, const std::string& name)> progress;
};

/// A flight to be made.
struct PlannedReflight {
  std::string name;
  std::vector<CauseChange> changes;
  bool other_seed = false;
};

/// The re-flights of one run. A flight that was made before, by this or an earlier call, is not
/// flown again, and counts only once.
class Reflights {
 public:
  Reflights(ReflightOptions options, std::filesystem::path run_folder)
      : options_(std::move(options)),
        run_folder_(std::move(run_folder)),
        processes_(options_.program, options_.flight_options) {}

  /// Flights that may still be made.
  [[nodiscard]] std::size_t left() const;
  [[nodiscard]] const std::list<Reflight>& flights() const { return flights_; }

  /// Flies `document`, which flies `part`, with changes. The flights beyond left() are not made;
  /// their places are null. A flight that fails has its error in Reflight::error.
  /// Errors: kCancelled; kInvalidArgument for a change beyond the scenario's limits; kUnsupported
  /// if a flight needs more memory than there is; kIo.
  [[nodiscard]] Result<std::vector<const Reflight*>> fly(const nlohmann::json& document,
                                                         const CriticalPart& part,
                                                         const std::vector<PlannedReflight>& plan);

 private:
  struct Prepared;

  [[nodiscard]] Result<Prepared> prepare(const nlohmann::json& document,
                                         const CriticalPart& part,
                                         const PlannedReflight& planned) const;
  [[nodiscard]] Status fly_all(std::vector<Prepared>& waiting);
  [[nodiscard]] Status start(const Prepared& prepared);
  void take_results(const Prepared& prepared, const std::string& failure);

  ReflightOptions options_;
  std::filesystem::path run_folder_;
  FlightProcesses processes_;
  std::list<Reflight> flights_;
  std::set<std::string> known_pictures_;  ///< picture_key of the flights so far
};

}  // namespace overfly::server::experiments
