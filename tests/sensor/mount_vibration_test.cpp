// The shaken mount's motion against the spectrum that the model states.
#include "sensor/mount_vibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/time.hpp"
#include "tests/sensor/flat_field.hpp"

namespace overfly::sensor {
namespace {

constexpr int kSamples = 256;     // of one segment
constexpr double kRateHz = 640.;  // a line of the estimate every 2.5 Hz
constexpr int kSeeds = 150;

/// Engine at 80 and 160 Hz, noise from 5 to 250 Hz, a mount with a resonance at 40 Hz.
VibrationModel shaken_mount() {
  VibrationModel model;
  model.enabled = true;
  model.engine_rpm = 4800.0;
  model.engine_rotation_rms_rad = {4e-4, 2e-4};
  model.engine_translation_rms_m = {1e-4};
  model.noise_rotation_rms_rad = {2e-4, 1e-4, 3e-4};
  model.noise_translation_rms_m = {1e-4, 2e-4, 5e-4};
  model.noise_low_hz = 5.0;
  model.noise_high_hz = 250.0;
  model.mount_natural_hz = 40.0;
  model.mount_damping = 0.15;
  return model;
}

MountVibration made(const VibrationModel& model, std::uint64_t seed = 1) {
  return MountVibration::create(model, seed).value();
}

double hann(int i) { return 0.5 - 0.5 * std::cos(2.0 * kPi * i / kSamples); }

std::vector<double> record_of(const MountVibration& vibration, VibrationAxis axis, int samples) {
  std::vector<double> record;
  for (int i = 0; i < samples; ++i) {
    const auto t_ns = static_cast<std::int64_t>(std::llround(1e9 * i / kRateHz));
    record.push_back(vibration.disturbance(t_ns)[static_cast<std::size_t>(axis)]);
  }
  return record;
}

/// One-sided density per line: segments with a Hann window that overlap by half (Welch 1967, "The
/// use of fast Fourier transform for the estimation of power spectra", IEEE Trans. AU-15).
std::vector<double> welch(const std::vector<double>& record) {
  double window_power = 0.0;
  for (int i = 0; i < kSamples; ++i) window_power += hann(i) * hann(i);
  std::vector<double> density(kSamples / 2, 0.0);
  int segments = 0;
  for (std::size_t start = 0; start + kSamples <= record.size(); start += kSamples / 2) ++segments;
  for (int segment = 0; segment < segments; ++segment) {
    for (int k = 1; k < kSamples / 2; ++k) {
      double re = 0.0;
      double im = 0.0;
      for (int i = 0; i < kSamples; ++i) {
        const double value = hann(i) * record[static_cast<std::size_t>(segment) * kSamples / 2 + i];
        re += value * std::cos(2.0 * kPi * k * i / kSamples);
        im += value * std::sin(2.0 * kPi * k * i / kSamples);
      }
      density[k] += 2.0 * (re * re + im * im) / (kRateHz * window_power * segments);
    }
  }
  return density;
}

/// What Welch's estimate of the stated spectrum is on average: the transform of the
/// autocorrelation times that of the window, so that leakage is no excuse.
std::vector<double> expected_welch(const MountVibration& vibration, VibrationAxis axis) {
  constexpr double kStepHz = 0.1;
  std::vector<double> weighted(kSamples, 0.0);
  double window_power = 0.0;
  for (int i = 0; i < kSamples; ++i) window_power += hann(i) * hann(i);
  for (int lag = 0; lag < kSamples; ++lag) {
    double autocorrelation = 0.0;
    const double angle = 2.0 * kPi * lag / kRateHz;
    for (double f_hz = 0.5 * kStepHz; f_hz < 0.5 * kRateHz; f_hz += kStepHz) {
      autocorrelation += kStepHz * vibration.psd(axis, f_hz) * std::cos(angle * f_hz);
    }
    for (const VibrationLine& line : vibration.lines(axis)) {
      autocorrelation += line.variance * std::cos(angle * line.f_hz);
    }
    for (int i = 0; i + lag < kSamples; ++i) weighted[lag] += hann(i) * hann(i + lag);
    weighted[lag] *= autocorrelation;
  }
  std::vector<double> density(kSamples / 2, 0.0);
  for (int k = 1; k < kSamples / 2; ++k) {
    double sum = weighted[0];
    for (int lag = 1; lag < kSamples; ++lag) {
      sum += 2.0 * weighted[lag] * std::cos(2.0 * kPi * k * lag / kSamples);
    }
    density[k] = 2.0 * sum / (kRateHz * window_power);
  }
  return density;
}

TEST(MountVibration, WelchsEstimateIsTheStatedSpectrum) {
  const VibrationModel model = shaken_mount();
  for (const VibrationAxis axis : {VibrationAxis::kRotationX, VibrationAxis::kZ}) {
    const std::vector<double> expected = expected_welch(made(model), axis);
    std::vector<double> sum(expected.size(), 0.0);
    std::vector<double> squares(expected.size(), 0.0);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const auto density = welch(record_of(made(model, seed), axis, kSamples));
      for (std::size_t k = 1; k < density.size(); ++k) {
        sum[k] += density[k] / kSeeds;
        squares[k] += density[k] * density[k] / kSeeds;
      }
    }
    // Lines from 5 Hz on, four of them together (10 Hz); 30 places.
    double worst = 0.0;
    double sum_of_ratios = 0.0;
    int bands = 0;
    for (std::size_t k = 2; k + 4 < 102; k += 4) {
      double seen = 0.0;
      double stated = 0.0;
      double variance = 0.0;
      for (std::size_t i = k; i < k + 4; ++i) {
        seen += sum[i];
        stated += expected[i];
        // Neighbouring lines are correlated by the window: taken as wholly so.
        variance += 4.0 * (squares[i] - sum[i] * sum[i]) / kSeeds;
      }
      EXPECT_NEAR(seen, stated, 4.0 * std::sqrt(variance)) << 2.5 * static_cast<double>(k) << " Hz";
      worst = std::max(worst, std::sqrt(variance) / stated);
      sum_of_ratios += seen / stated;
      ++bands;
    }
    EXPECT_LT(worst, 0.15) << "the estimate must be accurate enough for the comparison";
    // 0.15 / sqrt(25) = 0.03 at most.
    EXPECT_NEAR(sum_of_ratios / bands, 1.0, 0.06);
  }
}

TEST(MountVibration, VarianceIsTheIntegralOfTheSpectrum) {
  const VibrationModel model = shaken_mount();
  for (int axis = 0; axis < 6; ++axis) {
    const auto of = static_cast<VibrationAxis>(axis);
    const MountVibration one = made(model);
    double stated = 0.0;
    for (double f_hz = 0.05; f_hz < 300.0; f_hz += 0.1) stated += 0.1 * one.psd(of, f_hz);
    for (const VibrationLine& line : one.lines(of)) stated += line.variance;
    EXPECT_NEAR(one.rms(of), std::sqrt(stated), 2e-3 * one.rms(of));
    std::vector<double> values;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const auto record = record_of(made(model, seed), of, 120);
      values.insert(values.end(), record.begin(), record.end());
    }
    double mean_square = 0.0;
    for (const double value : values) mean_square += value * value / values.size();
    EXPECT_NEAR(std::sqrt(mean_square), one.rms(of), 0.1 * one.rms(of)) << axis;
  }
}

TEST(MountVibration, NoiseIsNearNormalAndItsAxesIndependent) {
  VibrationModel model = shaken_mount();
  model.engine_rotation_rms_rad.clear();
  model.engine_translation_rms_m.clear();
  std::array<std::vector<double>, 6> axes;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const MountVibration vibration = made(model, seed);
    for (int i = 0; i < 40; ++i) {
      const auto d = vibration.disturbance(i * 53'000'000LL);
      for (std::size_t axis = 0; axis < 6; ++axis) axes[axis].push_back(d[axis]);
    }
  }
  // Samples of one seed 53 ms apart hang together a little: bounds of a quarter of their number.
  const double n = 0.25 * static_cast<double>(axes[0].size());
  for (std::size_t a = 0; a < 6; ++a) {
    const testing::Moments m = testing::moments_of(axes[a]);
    EXPECT_NEAR(m.skewness, 0.0, 5.0 * std::sqrt(6.0 / n));
    EXPECT_NEAR(m.excess_kurtosis, 0.0, 5.0 * std::sqrt(24.0 / n));
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_NEAR(testing::correlation(axes[a], axes[b]), 0.0, 5.0 / std::sqrt(n)) << a << b;
    }
  }
}

TEST(MountVibration, MountPassesWhatADampedSpringPasses) {
  VibrationModel model = shaken_mount();
  EXPECT_DOUBLE_EQ(model.power_transmission(0.0), 1.0);
  EXPECT_NEAR(model.power_transmission(40.0), 1.0 / (0.3 * 0.3), 1e-12);
  // Far above the resonance the amplitude falls as 1 / f^2.
  EXPECT_NEAR(model.power_transmission(8000.0) / model.power_transmission(4000.0), 1.0 / 16, 1e-3);
  model.mount_natural_hz = 0.0;
  EXPECT_DOUBLE_EQ(model.power_transmission(123.0), 1.0);
  EXPECT_NEAR(made(model).lines(VibrationAxis::kRotationY)[1].variance, 4e-8, 1e-20);
  EXPECT_DOUBLE_EQ(made(model).lines(VibrationAxis::kRotationY)[1].f_hz, 160.0);
}

TEST(MountVibration, PoseIsTheDisturbance) {
  const MountVibration vibration = made(shaken_mount(), 3);
  for (const std::int64_t t_ns : {0LL, 1'234'567LL, 3'600'000'000'000LL}) {
    const auto d = vibration.disturbance(t_ns);
    const Pose pose = vibration.T_mount_camera(t_ns);
    const Eigen::AngleAxisd turned(pose.rotation);
    const Eigen::Vector3d rotation = turned.angle() * turned.axis();
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(rotation[i], d[i], 1e-12);
      EXPECT_EQ(pose.translation[i], d[i + 3]);
    }
  }
}

TEST(MountVibration, TheSameSeedShakesTheSame) {
  const VibrationModel model = shaken_mount();
  const auto once = made(model, 5).disturbance(77'000'000);
  EXPECT_EQ(made(model, 5).disturbance(77'000'000), once);
  EXPECT_NE(made(model, 6).disturbance(77'000'000), once);
  EXPECT_EQ(made(VibrationModel{}).disturbance(123), (std::array<double, 6>{}));
}

TEST(MountVibration, IsFiniteWhereMostOfTheBandIsBlocked) {
  VibrationModel model = shaken_mount();
  model.noise_low_hz = 0.01;
  model.noise_high_hz = 2000.0;
  for (const double natural_hz : {0.2, 1e-3, 1e-300}) {
    model.mount_natural_hz = natural_hz;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Pose pose = made(model, seed).T_mount_camera(1'234'567'890);
      EXPECT_TRUE(pose.translation.allFinite()) << natural_hz;
      EXPECT_TRUE(pose.rotation.coeffs().allFinite()) << natural_hz;
    }
  }
}

TEST(MountVibration, NamesTheFieldThatIsOutOfItsLimits) {
  const auto message = [](const std::function<void(VibrationModel&)>& change) {
    VibrationModel model = shaken_mount();
    change(model);
    const auto vibration = MountVibration::create(model, 1);
    return vibration.ok() ? std::string("accepted") : vibration.error().message;
  };
  const std::pair<const char*, std::function<void(VibrationModel&)>> bad[] = {
      {"vibration: engine_rpm = 0", [](auto& m) { m.engine_rpm = 0.0; }},
      {"engine_rotation_rms_rad[1] = 0.2", [](auto& m) { m.engine_rotation_rms_rad[1] = 0.2; }},
      {"noise_translation_rms_m[2] = -1", [](auto& m) { m.noise_translation_rms_m[2] = -1.0; }},
      {"noise_high_hz = 4", [](auto& m) { m.noise_high_hz = 4.0; }},
      {"mount_damping = 0", [](auto& m) { m.mount_damping = 0.0; }},
      {"at most 20", [](auto& m) { m.engine_rotation_rms_rad.assign(21, 1e-5); }},
  };
  for (const auto& [expected, change] : bad) {
    EXPECT_NE(message(change).find(expected), std::string::npos) << message(change);
  }
}

}  // namespace
}  // namespace overfly::sensor
