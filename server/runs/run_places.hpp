// Where the folders of runs are: in the folder of runs, or in those of sweeps.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace overfly::server {

/// A run of a sweep: its id is SWEEP.RUN, and RUN has 20 hexadecimal digits.
struct SweepRunName {
  std::string sweep;
  std::string run;
};

class RunPlaces {
 public:
  /// @param sweeps_folder  empty = there are no sweeps
  RunPlaces(std::filesystem::path runs_folder, std::filesystem::path sweeps_folder)
      : runs_folder_(std::move(runs_folder)), sweeps_folder_(std::move(sweeps_folder)) {}

  /// The folder of a run, which may be absent. A run in the folder of runs precedes one of a sweep
  /// with the same id. @pre is_plain_name(id)
  [[nodiscard]] std::filesystem::path of(const std::string& id) const;
  /// Empty if a run is none of a sweep. @pre is_plain_name(id)
  [[nodiscard]] std::optional<SweepRunName> in_sweep(const std::string& id) const;

 private:
  std::filesystem::path runs_folder_;
  std::filesystem::path sweeps_folder_;
};

}  // namespace overfly::server
