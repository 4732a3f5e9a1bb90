#include "flight/vehicle/serve_vehicle.hpp"

#include <algorithm>
#include <chrono>

namespace overfly::vehicle {
namespace {

using flight::mavlink::FrameLink;
using flight::mavlink::LinkClock;

/// Steps at once; a vehicle further behind gives the time up.
constexpr int kMaxStepsAtOnce = 100;

}  // namespace

Status serve_vehicle(SimulatedVehicle& vehicle,
                     const flight::mavlink::LinkAddress& address,
                     double speed_up,
                     const std::atomic<bool>& stop,
                     const std::function<void(const flight::mavlink::LinkAddress&)>& opened) {
  flight::mavlink::LinkOptions options;
  options.system = vehicle.setup().system;
  options.component = 1;  // MAV_COMP_ID_AUTOPILOT1
  options.keeps_silent_peers = true;
  auto link = FrameLink::create(address, options, LinkClock::now());
  if (!link) return link.error();
  opened((*link)->address());
  // Messages that no peer takes are counted by the link.
  const Send send = [&](flight::mavlink::MessageId id,
                        const flight::mavlink::PayloadWriter& payload,
                        std::uint8_t system) {
    (void)(*link)->send(static_cast<std::uint32_t>(id), payload.bytes(), system);
  };
  const auto step_time =
      std::chrono::duration_cast<LinkClock::duration>(std::chrono::duration<double, std::nano>(
          static_cast<double>(SimulatedVehicle::kStepNs) / speed_up));
  LinkClock::time_point next = LinkClock::now();
  while (!stop.load()) {
    const LinkClock::time_point now = LinkClock::now();
    int steps = 0;
    for (; next <= now && steps < kMaxStepsAtOnce; ++steps, next += step_time) vehicle.step(send);
    if (steps == kMaxStepsAtOnce) next = now;
    const auto wait =
        std::chrono::duration_cast<std::chrono::milliseconds>(next - LinkClock::now());
    (*link)->step(LinkClock::now(),
                  std::clamp(wait, std::chrono::milliseconds(1), std::chrono::milliseconds(50)),
                  [&](const flight::mavlink::Frame& frame) { vehicle.take(frame, send); });
  }
  return {};
}

}  // namespace overfly::vehicle
