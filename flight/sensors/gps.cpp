#include "flight/sensors/gps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/time.hpp"

namespace overfly::flight {

Gps::Gps(const GpsModel& model, std::vector<TimeSpan> outages, std::uint64_t seed)
    : model_(model),
      outages_(std::move(outages)),
      noise_(seed),
      north_(model.horizontal_drift_m, model.drift_time_s, 1.0 / model.rate_hz),
      east_(north_),
      down_(model.vertical_drift_m, model.drift_time_s, 1.0 / model.rate_hz) {}

bool Gps::has_fix(std::int64_t t_ns) const {
  return std::none_of(outages_.begin(), outages_.end(), [&](const TimeSpan& span) {
    return t_ns >= span.begin_ns && t_ns < span.end_ns;
  });
}

GpsSample Gps::measure(const AircraftState& state, const SensorPlace& place) {
  const double north_m = north_.next(noise_) + model_.horizontal_noise_m * noise_.draw();
  const double east_m = east_.next(noise_) + model_.horizontal_noise_m * noise_.draw();
  const double down_m = down_.next(noise_) + model_.vertical_noise_m * noise_.draw();
  Eigen::Vector3d velocity_error;
  for (double& error : velocity_error) error = model_.velocity_noise_m_s * noise_.draw();

  GpsSample sample;
  sample.t_ns = state.t_ns;
  sample.delivered_ns = state.t_ns + ns_from_s(model_.delay_s);
  if (!has_fix(state.t_ns)) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    sample.fix = GpsFixType::kNone;
    sample.place = {kNan, kNan, kNan};
    sample.velocity_ned_m_s.setConstant(kNan);
    sample.horizontal_accuracy_m = sample.vertical_accuracy_m = sample.speed_accuracy_m_s = kNan;
    return sample;
  }
  const Geodetic truth = place.frame.geodetic_from_world(state.T_world_body.translation);
  sample.place = LocalFrame(truth).geodetic_from_world({east_m, north_m, -down_m});
  const Eigen::Vector3d v_enu =
      place.frame.R_world_enu_at(truth).conjugate() * state.v_body_world_m_s;
  sample.velocity_ned_m_s = Eigen::Vector3d(v_enu.y(), v_enu.x(), -v_enu.z()) + velocity_error;
  sample.horizontal_accuracy_m = std::hypot(model_.horizontal_drift_m, model_.horizontal_noise_m);
  sample.vertical_accuracy_m = std::hypot(model_.vertical_drift_m, model_.vertical_noise_m);
  sample.speed_accuracy_m_s = model_.velocity_noise_m_s;
  return sample;
}

}  // namespace overfly::flight
