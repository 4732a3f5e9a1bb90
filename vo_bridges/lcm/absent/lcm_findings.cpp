// LCM findings of a build without LCM.
#include "vo_bridges/lcm/lcm_findings.hpp"

namespace overfly {

LcmFindings lcm_findings_from(const std::string& /*multicast_fault*/,
                              long long /*receive_buffer_bytes*/) {
  return {false, "not built in", "install liblcm-dev and liblcm-bin, and rebuild"};
}

LcmFindings lcm_findings() { return lcm_findings_from("", 0); }

}  // namespace overfly
