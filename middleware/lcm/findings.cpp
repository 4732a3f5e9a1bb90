#include "middleware/lcm/findings.hpp"

#include <lcm/lcm.h>

#include "middleware/lcm/node.hpp"
#include "middleware/lcm/url.hpp"

namespace overfly::lcm {

bool is_built_in() { return true; }

Findings findings_from(const std::string& multicast_fault, long long receive_buffer_bytes) {
  const std::string version = "LCM " + std::to_string(LCM_MAJOR_VERSION) + "." +
                              std::to_string(LCM_MINOR_VERSION) + "." +
                              std::to_string(LCM_MICRO_VERSION);
  if (!multicast_fault.empty()) {
    return {false,
            version + ", but " + multicast_fault,
            "ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo; allow "
            "UDP to 224.0.0.0/4 in the firewall"};
  }
  const std::string buffer = "net.core.rmem_max = " + std::to_string(receive_buffer_bytes);
  if (receive_buffer_bytes > 0 && receive_buffer_bytes < kSmallestReceiveBufferBytes) {
    return {false,
            version + ", multicast works, but " + buffer +
                " makes receivers lose most packets of a large image",
            "sysctl -w net.core.rmem_max=8388608 (and into /etc/sysctl.d)"};
  }
  return {true, version + ", multicast works, " + buffer, ""};
}

Findings findings() {
  const Status multicast = probe_multicast(parse_url("udpm://").value().address());
  return findings_from(multicast ? "" : multicast.error().message, largest_receive_buffer_bytes());
}

}  // namespace overfly::lcm
