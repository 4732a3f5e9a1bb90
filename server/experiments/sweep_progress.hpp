// How far a sweep is, and the file in its folder that tells it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/result.hpp"

namespace overfly::server::experiments {

struct SweepProgress {
  std::size_t passed = 0;  ///< flights that are over or need not be flown
  std::size_t most = 0;    ///< flights at most
  std::size_t flown = 0;   ///< in this call
  std::size_t failed = 0;  ///< in this call
  /// Estimate for the rest; empty while it is not known: before the first flight is over.
  std::optional<double> left_s;
  /// By all flights of the sweep so far, one after the other: those of this call with failed
  /// attempts, those of earlier calls as far as they have a result.
  double spent_s = 0.0;
};

/// Errors: kIo.
Status write_progress(const std::filesystem::path& folder, const SweepProgress& progress);
/// The fields of SweepProgress by their names; null if the file is missing or invalid.
[[nodiscard]] nlohmann::json read_progress(const std::filesystem::path& folder);

}  // namespace overfly::server::experiments
