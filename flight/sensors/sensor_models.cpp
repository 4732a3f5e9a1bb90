#include "flight/sensors/sensor_models.hpp"

#include <string>

#include "core/text/number_text.hpp"

namespace overfly::flight {
namespace {

constexpr double kMinRateHz = 1e-3;
constexpr double kMaxRateHz = 1000.0;
constexpr double kMaxError = 1e5;
constexpr double kMaxDensity = 1e3;
constexpr double kMinDriftTimeS = 0.1;
constexpr double kMaxDriftTimeS = 1e6;

Error out_of_limits(
    const std::string& sensor, const char* field, double value, double min, double max) {
  return {ErrorCode::kInvalidArgument,
          sensor + "." + field + " = " + number_text(value) + ": must be in [" + number_text(min) +
              ", " + number_text(max) + "]"};
}

template <typename Model>
Status check_model(const std::string& sensor, const Model& model) {
  for (const ModelField<Model>& field : fields_of<Model>()) {
    const double value = model.*field.value;
    // False for a value that is not a number.
    if (value >= field.min && value <= field.max) continue;
    return out_of_limits(sensor, field.name, value, field.min, field.max);
  }
  return {};
}

}  // namespace

template <>
std::span<const ModelField<ImuModel>> fields_of() {
  using M = ImuModel;
  constexpr double kMaxImuRateHz = 10000.0;
  static constexpr ModelField<M> kFields[] = {
      {"rate_hz", &M::rate_hz, kMinRateHz, kMaxImuRateHz},
      {"gyroscope_noise_rad_s_sqrt_hz", &M::gyroscope_noise_rad_s_sqrt_hz, 0.0, kMaxDensity},
      {"gyroscope_walk_rad_s2_sqrt_hz", &M::gyroscope_walk_rad_s2_sqrt_hz, 0.0, kMaxDensity},
      {"accelerometer_noise_m_s2_sqrt_hz", &M::accelerometer_noise_m_s2_sqrt_hz, 0.0, kMaxDensity},
      {"accelerometer_walk_m_s3_sqrt_hz", &M::accelerometer_walk_m_s3_sqrt_hz, 0.0, kMaxDensity}};
  return kFields;
}

template <>
std::span<const ModelField<BarometerModel>> fields_of() {
  using M = BarometerModel;
  static constexpr ModelField<M> kFields[] = {
      {"rate_hz", &M::rate_hz, kMinRateHz, kMaxRateHz},
      {"noise_pa", &M::noise_pa, 0.0, kMaxError},
      {"drift_pa", &M::drift_pa, 0.0, kMaxError},
      {"temperature_noise_k", &M::temperature_noise_k, 0.0, kMaxError},
      {"temperature_drift_k", &M::temperature_drift_k, 0.0, kMaxError},
      {"drift_time_s", &M::drift_time_s, kMinDriftTimeS, kMaxDriftTimeS}};
  return kFields;
}

template <>
std::span<const ModelField<GpsModel>> fields_of() {
  using M = GpsModel;
  constexpr double kMaxDelayS = 10.0;
  static constexpr ModelField<M> kFields[] = {
      {"rate_hz", &M::rate_hz, kMinRateHz, kMaxRateHz},
      {"delay_s", &M::delay_s, 0.0, kMaxDelayS},
      {"horizontal_drift_m", &M::horizontal_drift_m, 0.0, kMaxError},
      {"vertical_drift_m", &M::vertical_drift_m, 0.0, kMaxError},
      {"drift_time_s", &M::drift_time_s, kMinDriftTimeS, kMaxDriftTimeS},
      {"horizontal_noise_m", &M::horizontal_noise_m, 0.0, kMaxError},
      {"vertical_noise_m", &M::vertical_noise_m, 0.0, kMaxError},
      {"velocity_noise_m_s", &M::velocity_noise_m_s, 0.0, kMaxError}};
  return kFields;
}

template <>
std::span<const ModelField<AirspeedModel>> fields_of() {
  using M = AirspeedModel;
  static constexpr ModelField<M> kFields[] = {
      {"rate_hz", &M::rate_hz, kMinRateHz, kMaxRateHz},
      {"noise_pa", &M::noise_pa, 0.0, kMaxError},
      {"drift_pa", &M::drift_pa, 0.0, kMaxError},
      {"drift_time_s", &M::drift_time_s, kMinDriftTimeS, kMaxDriftTimeS}};
  return kFields;
}

template <>
std::span<const ModelField<MagnetometerModel>> fields_of() {
  using M = MagnetometerModel;
  static constexpr ModelField<M> kFields[] = {{"rate_hz", &M::rate_hz, kMinRateHz, kMaxRateHz},
                                              {"noise_ut", &M::noise_ut, 0.0, kMaxError},
                                              {"bias_ut", &M::bias_ut, 0.0, kMaxError}};
  return kFields;
}

template <>
std::span<const ModelField<RangeModel>> fields_of() {
  using M = RangeModel;
  constexpr double kMinReachM = 0.1;
  static constexpr ModelField<M> kFields[] = {{"rate_hz", &M::rate_hz, kMinRateHz, kMaxRateHz},
                                              {"noise_m", &M::noise_m, 0.0, kMaxError},
                                              {"max_m", &M::max_m, kMinReachM, kMaxError},
                                              {"min_m", &M::min_m, 0.0, kMaxError}};
  return kFields;
}

ImuModel ImuModel::ideal(double rate_hz) { return {rate_hz, 0.0, 0.0, 0.0, 0.0}; }

Status ImuModel::validate() const { return check_model("imu", *this); }

Status SensorModels::validate() const {
  Status status;
  with_each([&](const char* name, const auto& model) {
    if (status && model) status = check_model(name, *model);
  });
  if (!status || !range) return status;
  const double max_m = 0.999 * range->max_m;
  if (range->min_m <= max_m) return {};
  return out_of_limits("range", "min_m", range->min_m, 0.0, max_m);
}

}  // namespace overfly::flight
