// Exit codes of the program (docs/COMMAND_LINE.md), and their mapping from errors.
#pragma once

#include "core/result.hpp"

namespace overfly::app {

enum ExitCode : int {
  kExitOk = 0,
  kExitFailure = 1,      ///< a failure not caused by the user
  kExitUsage = 2,        ///< invalid option, file or scenario
  kExitCancelled = 3,    ///< stopped by SIGINT or SIGTERM; results so far are kept
  kExitUnsupported = 4,  ///< not supported by this build or machine
  kExitIncomplete = 5,   ///< a sweep is over, but some of its flights failed
};

[[nodiscard]] int exit_code_of(ErrorCode code);

/// Prints "error: ..." to standard error. @return its exit code
int report(const Error& error);

}  // namespace overfly::app
