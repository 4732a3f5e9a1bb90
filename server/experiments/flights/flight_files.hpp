// The files of flights that are flown as processes: scenarios/ID.json, runs/ID, output/ID.txt.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/flights/flight_executor.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server::experiments {

class FlightFiles {
 public:
  explicit FlightFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Creates the folders. Errors: kIo.
  [[nodiscard]] Status create() const;
  [[nodiscard]] std::filesystem::path run(const std::string& id) const;
  /// Whether a flight has results, so that it need not be flown again: its run was completed, and
  /// at least one estimator ran.
  [[nodiscard]] bool is_completed(const std::string& id) const;
  /// Starts the flight of a scenario. The run folder of a flight that was not completed is removed.
  /// @param options  as FlightJob::options
  /// Errors: kIo; as FlightExecutor::start.
  [[nodiscard]] Status launch(FlightExecutor& executor,
                              const std::string& id,
                              const Scenario& scenario,
                              double timeout_s,
                              std::vector<std::string> options) const;
  /// Why no estimator of a completed run ran; empty if one did.
  [[nodiscard]] std::string none_ran(const std::string& id) const;
  /// Why a flight that has ended has no results (of any estimator); empty if it has.
  [[nodiscard]] std::string failure(const EndedFlight& ended, double timeout_s) const;

 private:
  [[nodiscard]] std::filesystem::path output(const std::string& id) const;

  std::filesystem::path folder_;
};

/// "estimator mine never ran: REASON"
[[nodiscard]] std::string never_ran_text(const std::string& estimator, const std::string& reason);

}  // namespace overfly::server::experiments
