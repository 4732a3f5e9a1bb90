#include "sensor/mount_vibration.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/time.hpp"
#include "sensor/noise_source.hpp"
#include "sensor/number_limit.hpp"

namespace overfly::sensor {

namespace {

constexpr std::size_t kAxes = 6;
constexpr std::size_t kNoiseTones = 128;
/// Steps of the integral of |H|^2 over the band; a resonance with damping 0.01 spans several.
constexpr std::size_t kSpectrumSteps = 8192;

Status check_lines(const char* field, const std::vector<double>& rms, double most) {
  if (rms.size() > 20) {
    return Error{ErrorCode::kInvalidArgument,
                 std::string(field) + " has " + std::to_string(rms.size()) +
                     " values: at most 20 harmonics"};
  }
  for (std::size_t i = 0; i < rms.size(); ++i) {
    const std::string name = std::string(field) + "[" + std::to_string(i) + "]";
    if (Status status = check_limits({{name.c_str(), rms[i], 0.0, most}}); !status) return status;
  }
  return {};
}

Status check_axes(const char* field, const std::array<double, 3>& rms, double most) {
  return check_lines(field, std::vector<double>(rms.begin(), rms.end()), most);
}

/// The camera's noise spectrum for an airframe of density 1, accumulated over its band.
struct CumulatedSpectrum {
  std::vector<double> f_hz;
  std::vector<double> power;  ///< up to f_hz

  explicit CumulatedSpectrum(const VibrationModel& model) {
    const double step_hz = (model.noise_high_hz - model.noise_low_hz) / kSpectrumSteps;
    f_hz.reserve(kSpectrumSteps + 1);
    power.reserve(kSpectrumSteps + 1);
    f_hz.push_back(model.noise_low_hz);
    power.push_back(0.0);
    for (std::size_t i = 0; i < kSpectrumSteps; ++i) {
      const double middle_hz = model.noise_low_hz + (static_cast<double>(i) + 0.5) * step_hz;
      f_hz.push_back(middle_hz + 0.5 * step_hz);
      power.push_back(power.back() + step_hz * model.power_transmission(middle_hz));
    }
  }

  [[nodiscard]] double total() const { return power.back(); }

  /// The frequency up to which the accumulated power is `wanted`.
  [[nodiscard]] double frequency_of(double wanted) const {
    const auto above = std::upper_bound(power.begin() + 1, power.end() - 1, wanted);
    const auto i = static_cast<std::size_t>(above - power.begin());
    const double step = power[i] - power[i - 1];  // 0 where steps are lost in the sum's rounding
    const double share = step > 0.0 ? (wanted - power[i - 1]) / step : 0.0;
    return f_hz[i - 1] + share * (f_hz[i] - f_hz[i - 1]);
  }

  /// Limits of the strata in accumulated power: half of them by power, half by bandwidth, so that
  /// both the resonance and the weak end of the band get enough tones. Strata are empty where the
  /// power is lost in the sum's rounding. @pre total() > 0
  [[nodiscard]] std::vector<double> strata() const {
    std::vector<double> limits;
    limits.reserve(kNoiseTones + 1);
    limits.push_back(0.0);
    const double band_hz = f_hz.back() - f_hz.front();
    for (std::size_t i = 1; i < power.size(); ++i) {
      const double passed = 0.5 * power[i] / total() + 0.5 * (f_hz[i] - f_hz.front()) / band_hz;
      const double next = static_cast<double>(limits.size()) / kNoiseTones;
      if (passed >= next && limits.size() < kNoiseTones) limits.push_back(power[i]);
    }
    limits.push_back(total());
    return limits;
  }
};

}  // namespace

Status VibrationModel::validate() const {
  Status numbers = check_limits({
      {"engine_rpm", engine_rpm, 1.0, 1e6},
      {"noise_low_hz", noise_low_hz, 0.01, 1e4},
      {"noise_high_hz", noise_high_hz, noise_low_hz * 1.01, 1e5},
      {"mount_natural_hz", mount_natural_hz, 0.0, 1e4},
      {"mount_damping", mount_damping, 0.01, 10.0},
  });
  if (!numbers) return numbers;
  constexpr double kMostRad = 0.1;
  constexpr double kMostM = 1.0;
  for (Status status : {check_lines("engine_rotation_rms_rad", engine_rotation_rms_rad, kMostRad),
                        check_lines("engine_translation_rms_m", engine_translation_rms_m, kMostM),
                        check_axes("noise_rotation_rms_rad", noise_rotation_rms_rad, kMostRad),
                        check_axes("noise_translation_rms_m", noise_translation_rms_m, kMostM)}) {
    if (!status) return status;
  }
  return {};
}

double VibrationModel::power_transmission(double f_hz) const {
  if (mount_natural_hz <= 0.0) return 1.0;
  const double r = f_hz / mount_natural_hz;
  const double stiffness = 1.0 - r * r;
  const double damping = 2.0 * mount_damping * r;
  return 1.0 / (stiffness * stiffness + damping * damping);
}

Result<MountVibration> MountVibration::create(const VibrationModel& model, std::uint64_t seed) {
  if (Status status = model.validate(); !status) return status.error().in("vibration");
  MountVibration vibration(model);
  vibration.add_engine(seed);
  vibration.add_noise(seed);
  return vibration;
}

void MountVibration::add_engine(std::uint64_t seed) {
  SeededSequence random(seed ^ 0x656e67696e65U);
  const std::size_t harmonics =
      std::max(model_.engine_rotation_rms_rad.size(), model_.engine_translation_rms_m.size());
  for (std::size_t h = 0; h < harmonics; ++h) {
    Tone tone;
    const double f_hz = static_cast<double>(h + 1) * model_.engine_rpm / 60.0;
    tone.omega_rad_s = 2.0 * kPi * f_hz;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const auto& rms = axis < 3 ? model_.engine_rotation_rms_rad : model_.engine_translation_rms_m;
      const double phase = 2.0 * kPi * random.next();
      const double amplitude =
          h < rms.size() ? rms[h] * std::sqrt(2.0 * model_.power_transmission(f_hz)) : 0.0;
      tone.cosine[axis] = amplitude * std::cos(phase);
      tone.sine[axis] = -amplitude * std::sin(phase);
    }
    tones_.push_back(tone);
  }
}

void MountVibration::add_noise(std::uint64_t seed) {
  const CumulatedSpectrum spectrum(model_);
  mean_transmission_ = spectrum.total() / (model_.noise_high_hz - model_.noise_low_hz);
  std::array<double, kAxes> rms{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    rms[axis] =
        axis < 3 ? model_.noise_rotation_rms_rad[axis] : model_.noise_translation_rms_m[axis - 3];
  }
  const bool silent = std::all_of(rms.begin(), rms.end(), [](double v) { return v == 0.0; });
  if (silent || spectrum.total() <= 0.0) return;
  SeededSequence random(seed ^ 0x6e6f697365U);
  const std::vector<double> limits = spectrum.strata();
  for (std::size_t i = 0; i + 1 < limits.size(); ++i) {
    const double power = limits[i + 1] - limits[i];
    if (power <= 0.0) continue;
    Tone tone;
    const double f_hz = spectrum.frequency_of(limits[i] + power * random.next());
    tone.omega_rad_s = 2.0 * kPi * f_hz;
    const double share = power / (model_.noise_high_hz - model_.noise_low_hz);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const double phase = 2.0 * kPi * random.next();
      const double amplitude = rms[axis] * std::sqrt(2.0 * share);
      tone.cosine[axis] = amplitude * std::cos(phase);
      tone.sine[axis] = -amplitude * std::sin(phase);
    }
    tones_.push_back(tone);
  }
}

std::array<double, 6> MountVibration::disturbance(std::int64_t t_ns) const {
  const double t_s = s_from_ns(t_ns);
  std::array<double, 6> sum{};
  for (const Tone& tone : tones_) {
    const double cosine = std::cos(tone.omega_rad_s * t_s);
    const double sine = std::sin(tone.omega_rad_s * t_s);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      sum[axis] += tone.cosine[axis] * cosine + tone.sine[axis] * sine;
    }
  }
  return sum;
}

Pose MountVibration::T_mount_camera(std::int64_t t_ns) const {
  const std::array<double, 6> d = disturbance(t_ns);
  const Eigen::Vector3d rotation(d[0], d[1], d[2]);
  const double angle_rad = rotation.norm();
  Pose pose;
  if (angle_rad > 0.0) {
    pose.rotation = Eigen::AngleAxisd(angle_rad, rotation / angle_rad);
  }
  pose.translation = Eigen::Vector3d(d[3], d[4], d[5]);
  return pose;
}

double MountVibration::psd(VibrationAxis axis, double f_hz) const {
  if (f_hz < model_.noise_low_hz || f_hz > model_.noise_high_hz) return 0.0;
  const auto i = static_cast<std::size_t>(axis);
  const double rms =
      i < 3 ? model_.noise_rotation_rms_rad[i] : model_.noise_translation_rms_m[i - 3];
  return rms * rms / (model_.noise_high_hz - model_.noise_low_hz) * model_.power_transmission(f_hz);
}

std::vector<VibrationLine> MountVibration::lines(VibrationAxis axis) const {
  const bool rotation = static_cast<std::size_t>(axis) < 3;
  const auto& rms = rotation ? model_.engine_rotation_rms_rad : model_.engine_translation_rms_m;
  std::vector<VibrationLine> lines;
  lines.reserve(rms.size());
  for (std::size_t h = 0; h < rms.size(); ++h) {
    const double f_hz = static_cast<double>(h + 1) * model_.engine_rpm / 60.0;
    lines.push_back({f_hz, rms[h] * rms[h] * model_.power_transmission(f_hz)});
  }
  return lines;
}

double MountVibration::rms(VibrationAxis axis) const {
  const auto i = static_cast<std::size_t>(axis);
  const double noise =
      i < 3 ? model_.noise_rotation_rms_rad[i] : model_.noise_translation_rms_m[i - 3];
  double variance = noise * noise * mean_transmission_;
  for (const VibrationLine& line : lines(axis)) variance += line.variance;
  return std::sqrt(variance);
}

}  // namespace overfly::sensor
