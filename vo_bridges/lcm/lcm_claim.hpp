// Reserves an estimator's LCM channels within this process.
#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"

namespace overfly {

/// Two estimators on the same channels would receive each other's answers. The channels are
/// released on destruction. Thread-safe.
class LcmClaim {
 public:
  /// @param network  result of lcm::network_of for a URL
  /// Errors: kConflict naming prefix and network.
  [[nodiscard]] static Result<std::shared_ptr<LcmClaim>> take(const std::string& network,
                                                              const std::string& prefix);
  ~LcmClaim();
  LcmClaim(const LcmClaim&) = delete;
  LcmClaim& operator=(const LcmClaim&) = delete;

 private:
  explicit LcmClaim(std::string channels);
  const std::string channels_;
};

}  // namespace overfly
