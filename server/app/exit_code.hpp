// Exit codes of the program (docs/COMMAND_LINE.md) and the one place where errors become them.
#pragma once

#include "core/result.hpp"

namespace overfly::app {

enum ExitCode : int {
  kExitOk = 0,
  kExitFailure = 1,      ///< something failed that is not the caller's doing
  kExitUsage = 2,        ///< bad option, bad file, bad scenario
  kExitCancelled = 3,    ///< stopped by SIGINT or SIGTERM; what was done is kept
  kExitUnsupported = 4,  ///< this build or machine lacks what is asked
};

[[nodiscard]] int exit_code_of(ErrorCode code);

/// Prints "error: ..." to standard error. @return its exit code
int report(const Error& error);

}  // namespace overfly::app
