#include "server/camera/flight_sensors.hpp"

#include <utility>

#include "flight/gravity.hpp"

namespace overfly::server {

std::unique_ptr<flight::SensorSuite> create_sensors(const Scenario& scenario,
                                                    const terrain::World& world,
                                                    std::int64_t epoch_utc_ns) {
  if (scenario.sensors.none()) return nullptr;
  const LocalFrame& frame = world.tiles->frame();
  flight::SensorSuite::Options options{
      scenario.sensors,
      {frame, world.tiles, std::make_shared<const MagneticField>(epoch_utc_ns)},
      flight::normal_gravity_m_s2(frame.origin()),
      {},
      scenario.seed};
  for (const FaultSpec& fault : scenario.faults) {
    if (fault.kind != FaultKind::kGpsOutage) continue;
    options.gps_outages.push_back({fault.at_ns, fault.end_ns});
  }
  return std::make_unique<flight::SensorSuite>(std::move(options));
}

}  // namespace overfly::server
