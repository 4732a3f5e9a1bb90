// Inside terrain only: how the caller ends long work.
#pragma once

#include <filesystem>
#include <functional>

#include "core/result.hpp"

namespace overfly::terrain {

/// Asked between parts of the work; true ends it. May be empty.
using Cancelled = std::function<bool()>;

/// Errors: kCancelled naming the file.
[[nodiscard]] inline Status go_on(const Cancelled& cancelled, const std::filesystem::path& file) {
  if (!cancelled || !cancelled()) return {};
  return Error{ErrorCode::kCancelled, file.string() + ": reading it was cancelled"};
}

/// How many blocks of a file are looked at, without being read, between two questions.
inline constexpr int kBlocksAtOnce = 4096;

}  // namespace overfly::terrain
