// The samples that a flight of a log has.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <string>

#include "core/earth/height_query.hpp"
#include "core/sensors/sample_source.hpp"
#include "flight/replay/logged_flight.hpp"

namespace overfly::flight::testing {

struct FlownSensors {
  std::unique_ptr<TruthSource> flight;
  SensorSamples samples;
  std::string report;
};

inline FlownSensors sensors_of(const std::filesystem::path& file,
                               const LogFlightOptions& options = {}) {
  constexpr std::int64_t kForeverNs = std::numeric_limits<std::int64_t>::max() / 2;
  FlownSensors flown;
  auto flight = fly_flight_log(
      file, options, LocalFrame(geodetic_from_deg(47, 8, 0)), FlatGround(0.0), SourcePolicy());
  EXPECT_TRUE(flight.ok()) << (flight ? "" : flight.error().message);
  if (!flight) return flown;
  flown.flight = std::move(*flight);
  SampleSource* const source = flown.flight->sample_source();
  EXPECT_NE(source, nullptr);
  if (source == nullptr) return flown;
  flown.samples = source->take_samples(kForeverNs);
  flown.report = source->sensor_report();
  return flown;
}

}  // namespace overfly::flight::testing
