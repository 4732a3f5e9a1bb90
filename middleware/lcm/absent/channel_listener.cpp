// Channels in a build without LCM.
#include "middleware/lcm/channel_listener.hpp"

namespace overfly::lcm {

Result<std::shared_ptr<void>> listen_to_channel(
    const std::string& url,
    const std::string& /*channel*/,
    std::function<void(std::span<const std::uint8_t>)> /*take*/,
    const std::atomic<bool>* /*cancel*/) {
  return Error{ErrorCode::kUnsupported,
               url +
                   ": this build has no LCM support: install liblcm-dev and liblcm-bin, and "
                   "rebuild"};
}

}  // namespace overfly::lcm
