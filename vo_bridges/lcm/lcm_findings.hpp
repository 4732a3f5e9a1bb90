// What this machine offers to LCM: for `overfly doctor`.
#pragma once

#include <string>

namespace overfly {

struct LcmFindings {
  bool usable = false;  ///< built in, multicast comes back, and the receive buffer holds an image
  std::string finding;
  std::string remedy;  ///< empty when usable
};

/// Sends one packet to LCM's group, to this machine alone.
[[nodiscard]] LcmFindings lcm_findings();

/// As lcm_findings, from what was found.
/// @param multicast_fault       why multicast does not come back; empty where it does
/// @param receive_buffer_bytes  largest that the kernel allows; 0 = not known
[[nodiscard]] LcmFindings lcm_findings_from(const std::string& multicast_fault,
                                            long long receive_buffer_bytes);

}  // namespace overfly
