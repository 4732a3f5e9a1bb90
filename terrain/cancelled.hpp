// Cancellation of long operations.
#pragma once

#include <filesystem>
#include <functional>

#include "core/result.hpp"

namespace overfly::terrain {

/// Polled between parts of the work; returning true cancels it. May be empty.
using Cancelled = std::function<bool()>;

/// Errors: kCancelled naming the file.
[[nodiscard]] inline Status go_on(const Cancelled& cancelled, const std::filesystem::path& file) {
  if (!cancelled || !cancelled()) return {};
  return Error{ErrorCode::kCancelled, file.string() + ": reading it was cancelled"};
}

}  // namespace overfly::terrain
