// Runs a short command of the system and returns what it prints.
#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::server::experiments {

struct CommandOutput {
  int exit_code = 0;
  std::string text;  ///< standard output and standard error, at most 4 MiB
};

/// @param words  program, searched in PATH, and arguments; no shell is used
/// @param timeout_s  the command is killed after it
/// Errors: kNotFound if there is no such program; kInternal if it could not be run, was killed or
/// did not end in time. Each names the program.
[[nodiscard]] Result<CommandOutput> command_output(const std::vector<std::string>& words,
                                                   double timeout_s);

}  // namespace overfly::server::experiments
