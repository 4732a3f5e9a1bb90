// LCM findings of a build without LCM.
#include "middleware/lcm/findings.hpp"

namespace overfly::lcm {

bool is_built_in() { return false; }

Findings findings_from(const std::string& /*multicast_fault*/, long long /*receive_buffer_bytes*/) {
  return {false, "not built in", "install liblcm-dev and liblcm-bin, and rebuild"};
}

Findings findings() { return findings_from("", 0); }

}  // namespace overfly::lcm
