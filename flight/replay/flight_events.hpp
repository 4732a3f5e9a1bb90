// The events of a flight log as those of a flight.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/motion/flight_event.hpp"
#include "core/motion/truth_source.hpp"
#include "core/sensors/sample_source.hpp"
#include "flight/logs/flight_log.hpp"

namespace overfly::flight {

/// Other events than modes and mission items that a flight reports; a log may have thousands.
inline constexpr std::size_t kMaxOtherEvents = 500;

/// The events of one vehicle in a part of its flight, by time from `begin_ns`. The mode and the
/// mission item that are in force at the beginning come at 0. Mission items listed at one instant
/// are an upload, and left out.
/// @param source  stream of the flight's positions
/// @param boot    the run of the vehicle's clock that is flown, as LoggedTruth::boot
/// @param begin_ns, end_ns  by the vehicle's clock
[[nodiscard]] std::vector<FlightEvent> events_of(const logs::OpenedLog& log,
                                                 const std::string& source,
                                                 std::uint32_t boot,
                                                 std::int64_t begin_ns,
                                                 std::int64_t end_ns);

/// The same flight with events and the aircraft's sensors.
/// @param events   by time
/// @param sensors  null: those of the flight, if it has any
[[nodiscard]] std::unique_ptr<TruthSource> with_records(std::unique_ptr<TruthSource> flight,
                                                        std::vector<FlightEvent> events,
                                                        std::unique_ptr<SampleSource> sensors);

}  // namespace overfly::flight
