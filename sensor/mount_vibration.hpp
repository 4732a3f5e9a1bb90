// Vibration of the camera by engine and airframe through a compliant mount.
//
// The airframe shakes the mount about and along each axis of the camera with
//   - lines at h * rpm / 60, h = 1, 2, ... (engine and propeller), and
//   - noise of constant power spectral density between two frequencies.
// The mount is a mass on a damped spring, a second-order low-pass: with r = f / natural_hz,
//   |H(f)|^2 = 1 / ((1 - r^2)^2 + (2 damping r)^2)                       (rigid: |H| = 1).
// The camera's disturbance has the one-sided spectrum |H(f)|^2 * (airframe's). Axes are
// independent.
//
// Noise is a sum of cosines, one drawn in each stratum of the camera's spectrum, with uniform
// phases (Shinozuka, Deodatis 1991, "Simulation of stochastic processes by spectral
// representation", Appl. Mech. Rev. 44(4)). Strata are equal in the mean of their share of the
// power and their share of the bandwidth. It is stationary,
// nearly normal, and can be evaluated at any time without the preceding times.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/result.hpp"

namespace overfly::sensor {

struct VibrationModel {
  bool enabled = false;
  double engine_rpm = 6000.0;
  /// Standard deviation of the airframe's line h = 1, 2, ... about / along each axis; empty = none.
  std::vector<double> engine_rotation_rms_rad;
  std::vector<double> engine_translation_rms_m;
  /// Standard deviation of the airframe's noise over its band, about / along each camera axis.
  std::array<double, 3> noise_rotation_rms_rad{};
  std::array<double, 3> noise_translation_rms_m{};
  double noise_low_hz = 2.0;
  double noise_high_hz = 200.0;
  double mount_natural_hz = 30.0;  ///< 0 = a rigid mount
  double mount_damping = 0.2;      ///< ratio to critical

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
  /// |H(f)|^2 of the mount.
  [[nodiscard]] double power_transmission(double f_hz) const;
};

enum class VibrationAxis { kRotationX, kRotationY, kRotationZ, kX, kY, kZ };

/// A sharp line of the camera's spectrum.
struct VibrationLine {
  double f_hz = 0.0;
  double variance = 0.0;  ///< [rad^2] or [m^2]
};

/// The pose of the camera in its mount as a function of time. Immutable, thread-safe.
class MountVibration {
 public:
  /// Errors: as VibrationModel::validate.
  static Result<MountVibration> create(const VibrationModel& model, std::uint64_t seed);

  /// Transforms points of the vibrating camera to the camera at rest: T_body_camera *
  /// T_mount_camera(t).
  [[nodiscard]] Pose T_mount_camera(std::int64_t t_ns) const;
  /// Rotation vector and translation [rad, m] in the camera's axes.
  [[nodiscard]] std::array<double, 6> disturbance(std::int64_t t_ns) const;

  /// One-sided power spectral density of the camera's noise [rad^2/Hz or m^2/Hz], without lines.
  [[nodiscard]] double psd(VibrationAxis axis, double f_hz) const;
  [[nodiscard]] std::vector<VibrationLine> lines(VibrationAxis axis) const;
  /// Standard deviation of the camera's whole motion [rad or m].
  [[nodiscard]] double rms(VibrationAxis axis) const;

 private:
  /// A cosine with separate amplitude and phase for each axis.
  struct Tone {
    double omega_rad_s = 0.0;
    std::array<double, 6> cosine{};
    std::array<double, 6> sine{};
  };
  explicit MountVibration(const VibrationModel& model) : model_(model) {}
  void add_engine(std::uint64_t seed);
  void add_noise(std::uint64_t seed);

  VibrationModel model_;
  double mean_transmission_ = 1.0;  ///< of the noise's power, over its band
  std::vector<Tone> tones_;
};

}  // namespace overfly::sensor
