// Checks of the options with which `overfly log` writes files.
#pragma once

#include <optional>
#include <string>

#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"

namespace CLI {
class App;
}

namespace overfly::app {

/// Limits by the vehicle's clock.
struct LogTimes {
  std::optional<double> from_s;
  std::optional<double> to_s;

  /// Adds --from and --to.
  void add_to(CLI::App& command);
  /// Errors: kInvalidArgument naming option, value and limit.
  [[nodiscard]] Status check() const;
  /// @pre check()
  [[nodiscard]] flight::logs::LogSlice slice() const;
};

/// Options that `log convert` and `log smooth` have in common.
struct LogFlightArguments {
  std::string file;
  std::string source;
  std::string out;
  LogTimes times;
  std::optional<double> geoid_separation_m;
};

/// Errors: kInvalidArgument naming option, value and limit, also for a file that is part of the
/// log; kNotFound for a folder that does not exist; as files_of_log.
[[nodiscard]] Status check_log_flight(const LogFlightArguments& arguments);

/// Checks a file that is to be written.
/// Errors: as check_log_flight.
[[nodiscard]] Status check_log_output(const std::string& log,
                                      const std::string& option,
                                      const std::string& out);

}  // namespace overfly::app
