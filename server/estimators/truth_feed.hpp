// The truth of one camera's images as they are flown, for the test estimators.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

#include "vo_bridges/toy/toy_estimators.hpp"

namespace overfly::server {

/// Written by the run's thread and read by the estimators' threads. Keeps the last kTruthFeedImages
/// images.
class TruthFeed {
 public:
  /// @param stamp_ns  of the image as given to estimators
  void add(std::int64_t stamp_ns, const ToyTruth& truth);
  /// Empty if there is no such image.
  [[nodiscard]] std::optional<ToyTruth> at(std::int64_t stamp_ns) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::int64_t, ToyTruth> images_;  ///< by stamp
};

/// More than an estimator can lag behind its camera.
inline constexpr std::size_t kTruthFeedImages = 1024;

}  // namespace overfly::server
