// Checks of the options with which `overfly log` writes files.
#pragma once

#include <optional>
#include <string>

#include "core/result.hpp"

namespace overfly::app {

/// Options that `log convert` and `log smooth` have in common.
struct LogFlightArguments {
  std::string file;
  std::string source;
  std::string out;
  std::optional<double> from_s;
  std::optional<double> to_s;
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
