#include "server/scenario/document/flight/scenario_sensors.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

double number(const Json& sensor, const char* field) { return sensor.at(field).get<double>(); }

flight::ImuModel imu_from(const Json& imu) {
  flight::ImuModel model;
  model.rate_hz = number(imu, "rate_hz");
  model.gyroscope_noise_rad_s_sqrt_hz = number(imu, "gyroscope_noise_rad_s_sqrt_hz");
  model.gyroscope_walk_rad_s2_sqrt_hz = number(imu, "gyroscope_walk_rad_s2_sqrt_hz");
  model.accelerometer_noise_m_s2_sqrt_hz = number(imu, "accelerometer_noise_m_s2_sqrt_hz");
  model.accelerometer_walk_m_s3_sqrt_hz = number(imu, "accelerometer_walk_m_s3_sqrt_hz");
  return model;
}

flight::BarometerModel barometer_from(const Json& barometer) {
  flight::BarometerModel model;
  model.rate_hz = number(barometer, "rate_hz");
  model.noise_pa = number(barometer, "noise_pa");
  model.drift_pa = number(barometer, "drift_pa");
  model.temperature_noise_k = number(barometer, "temperature_noise_k");
  model.temperature_drift_k = number(barometer, "temperature_drift_k");
  model.drift_time_s = number(barometer, "drift_time_s");
  return model;
}

flight::GpsModel gps_from(const Json& gps) {
  flight::GpsModel model;
  model.rate_hz = number(gps, "rate_hz");
  model.delay_s = number(gps, "delay_s");
  model.horizontal_drift_m = number(gps, "horizontal_drift_m");
  model.vertical_drift_m = number(gps, "vertical_drift_m");
  model.drift_time_s = number(gps, "drift_time_s");
  model.horizontal_noise_m = number(gps, "horizontal_noise_m");
  model.vertical_noise_m = number(gps, "vertical_noise_m");
  model.velocity_noise_m_s = number(gps, "velocity_noise_m_s");
  return model;
}

flight::AirspeedModel airspeed_from(const Json& airspeed) {
  flight::AirspeedModel model;
  model.rate_hz = number(airspeed, "rate_hz");
  model.noise_pa = number(airspeed, "noise_pa");
  model.drift_pa = number(airspeed, "drift_pa");
  model.drift_time_s = number(airspeed, "drift_time_s");
  return model;
}

flight::MagnetometerModel magnetometer_from(const Json& magnetometer) {
  flight::MagnetometerModel model;
  model.rate_hz = number(magnetometer, "rate_hz");
  model.noise_ut = number(magnetometer, "noise_ut");
  model.bias_ut = number(magnetometer, "bias_ut");
  return model;
}

flight::RangeModel range_from(const Json& range) {
  flight::RangeModel model;
  model.rate_hz = number(range, "rate_hz");
  model.noise_m = number(range, "noise_m");
  model.min_m = number(range, "min_m");
  model.max_m = number(range, "max_m");
  return model;
}

}  // namespace

Status read_sensors(const Json& document, Scenario& scenario) {
  const auto sensors = document.find("sensors");
  if (sensors == document.end()) return {};
  const auto read = [&](const char* name, auto& model, auto from_json) {
    if (const auto sensor = sensors->find(name); sensor != sensors->end()) {
      model = from_json(*sensor);
    }
  };
  flight::SensorModels& models = scenario.sensors;
  read("imu", models.imu, imu_from);
  read("barometer", models.barometer, barometer_from);
  read("gps", models.gps, gps_from);
  read("airspeed", models.airspeed, airspeed_from);
  read("magnetometer", models.magnetometer, magnetometer_from);
  read("range", models.range, range_from);
  if (Status valid = models.validate(); !valid) {
    return Error{valid.error().code, "sensors." + valid.error().message};
  }
  return {};
}

}  // namespace overfly::server
