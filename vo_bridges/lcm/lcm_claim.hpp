// The channels of an estimator, which no other one of this process may have at the same time.
#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"

namespace overfly {

/// Two estimators on the same channels would answer for each other. Gives the channels back when it
/// ends. May be used from any thread.
class LcmClaim {
 public:
  /// @param network  lcm_network_of a URL
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
