// LCM door of a build without LCM.
#include "vo_bridges/lcm/lcm_estimator.hpp"

namespace overfly {

Result<std::unique_ptr<VoPort>> create_lcm_estimator(const LcmEstimatorOptions& /*options*/) {
  return Error{ErrorCode::kUnsupported,
               "this build has no LCM support: install liblcm-dev and liblcm-bin, and rebuild"};
}

}  // namespace overfly
