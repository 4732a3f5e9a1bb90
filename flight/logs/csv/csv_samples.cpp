#include "flight/logs/csv/csv_samples.hpp"

#include <limits>

#include "core/sensors/measured_samples.hpp"

namespace overfly::flight::logs {

SensorSamples csv_samples_of(const CsvPiece& piece,
                             const std::array<double, kCsvQuantities>& values,
                             std::int64_t t_ns) {
  const auto has = [&](CsvQuantity quantity) { return piece.column(quantity).has_value(); };
  const auto value = [&](CsvQuantity quantity) {
    return values[static_cast<std::size_t>(quantity)];
  };
  const auto vector = [&](CsvQuantity first) {
    return Eigen::Vector3d(values.data() + static_cast<std::size_t>(first));
  };
  SensorSamples samples;
  if (has(CsvQuantity::kRateX)) {
    (void)add_measured(samples,
                       ImuSample{t_ns, vector(CsvQuantity::kForceX), vector(CsvQuantity::kRateX)});
  }
  if (has(CsvQuantity::kFieldX)) {
    (void)add_measured(samples, MagnetometerSample{t_ns, vector(CsvQuantity::kFieldX)});
  }
  if (has(CsvQuantity::kPressure)) {
    constexpr double kUnknownK = std::numeric_limits<double>::quiet_NaN();
    (void)add_measured(samples, BarometerSample{t_ns, value(CsvQuantity::kPressure), kUnknownK});
  }
  if (has(CsvQuantity::kAirspeed)) {
    (void)add_measured(samples, airspeed_of_speed(t_ns, value(CsvQuantity::kAirspeed)));
  }
  if (has(CsvQuantity::kRange)) {
    (void)add_measured(samples, RangeSample{t_ns, value(CsvQuantity::kRange)});
  }
  if (piece.has_position() && piece.origin == SourceOrigin::kGps) {
    GpsSample sample = gps_without_fix(t_ns, t_ns);
    sample.fix = GpsFixType::k3d;
    sample.place = geodetic_from_deg(
        value(CsvQuantity::kLat), value(CsvQuantity::kLon), value(CsvQuantity::kAltMsl));
    (void)add_measured(samples, sample);
  }
  return samples;
}

}  // namespace overfly::flight::logs
