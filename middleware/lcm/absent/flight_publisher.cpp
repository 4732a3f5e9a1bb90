// Flights on LCM channels in a build without LCM.
#include "middleware/lcm/flight_publisher.hpp"

namespace overfly::lcm {

Result<std::unique_ptr<FlightPublisher>> FlightPublisher::open(
    const std::string& url, const std::atomic<bool>* /*cancel*/) {
  return Error{ErrorCode::kUnsupported,
               url +
                   ": this build has no LCM support: install liblcm-dev and liblcm-bin, and "
                   "rebuild"};
}

}  // namespace overfly::lcm
