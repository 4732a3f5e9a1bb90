#include "server/app/exit_code.hpp"

#include <iostream>

namespace overfly::app {

int exit_code_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
    case ErrorCode::kNotFound:
    case ErrorCode::kUnreadable:
    case ErrorCode::kConflict:
    case ErrorCode::kForbidden:
      return kExitUsage;
    case ErrorCode::kCancelled:
      return kExitCancelled;
    case ErrorCode::kUnsupported:
      return kExitUnsupported;
    case ErrorCode::kIo:
    case ErrorCode::kTimeout:
    case ErrorCode::kInternal:
      return kExitFailure;
  }
  return kExitFailure;
}

int report(const Error& error) {
  std::cerr << "error: " << error.message << "\n";
  return exit_code_of(error.code);
}

}  // namespace overfly::app
