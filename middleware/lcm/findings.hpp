// LCM support on this machine, for `overfly doctor`.
#pragma once

#include <string>

namespace overfly::lcm {

/// True if this build supports LCM.
[[nodiscard]] bool is_built_in();

struct Findings {
  bool usable = false;  ///< built in, multicast works, and the receive buffer holds an image
  std::string finding;
  std::string remedy;  ///< empty when usable
};

/// Tests multicast by sending one packet to LCM's group on this machine only.
[[nodiscard]] Findings findings();

/// As `findings`, from given measurements.
/// @param multicast_fault       why multicast does not work; empty if it does
/// @param receive_buffer_bytes  largest that the kernel allows; 0 = unknown
[[nodiscard]] Findings findings_from(const std::string& multicast_fault,
                                     long long receive_buffer_bytes);

}  // namespace overfly::lcm
