#include "tests/odometry/synthetic_flight.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace overfly::odometry::testing {
namespace {

constexpr double kGravity = 9.80665;

Image halved(const Image& image) {
  Image half(image.width_px / 2, image.height_px / 2, 1);
  for (int y = 0; y < half.height_px; ++y) {
    for (int x = 0; x < half.width_px; ++x) {
      const int sum = image.at(2 * x, 2 * y) + image.at(2 * x + 1, 2 * y) +
                      image.at(2 * x, 2 * y + 1) + image.at(2 * x + 1, 2 * y + 1);
      half.at(x, y) = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
  return half;
}

/// @param image  its sides are powers of two
float bilinear_repeated(const Image& image, double x, double y) {
  const auto below = [](double v) {
    const int truncated = static_cast<int>(v);
    return truncated - (truncated > v ? 1 : 0);
  };
  const int fx = below(x);
  const int fy = below(y);
  const int x0 = fx & (image.width_px - 1);
  const int y0 = fy & (image.height_px - 1);
  const int x1 = (fx + 1) & (image.width_px - 1);
  const int y1 = (fy + 1) & (image.height_px - 1);
  const auto ax = static_cast<float>(x - fx);
  const auto ay = static_cast<float>(y - fy);
  const std::uint8_t* const upper = &image.data[static_cast<std::size_t>(y0) * image.width_px];
  const std::uint8_t* const lower = &image.data[static_cast<std::size_t>(y1) * image.width_px];
  return (1.0F - ay) * ((1.0F - ax) * upper[x0] + ax * upper[x1]) +
         ay * ((1.0F - ax) * lower[x0] + ax * lower[x1]);
}

/// Roll that follows rectangles of bank with a limited rate and smooth ends.
double bank_at(const SyntheticFlightOptions& options, double t_s) {
  const double t = t_s - options.straight_s;
  if (t <= 0.0) return 0.0;
  // A quarter of a cosine swing reaches its largest rate, (bank * pi / T), at the middle.
  const double swing_s = kPi * options.bank_max_rad / options.roll_rate_max_rad_s;
  const double half_s = swing_s + options.hold_s;
  const double first_s = 0.5 * swing_s;
  if (t < first_s) {  // from level to the first bank, half as far in half the time
    return 0.5 * options.bank_max_rad * (1.0 - std::cos(kPi * t / first_s));
  }
  const double since = t - first_s;
  const auto number = static_cast<int>(since / half_s);
  const double phase = since - number * half_s;
  const double sign = number % 2 == 0 ? 1.0 : -1.0;
  if (phase < options.hold_s) return sign * options.bank_max_rad;
  return sign * options.bank_max_rad * std::cos(kPi * (phase - options.hold_s) / swing_s);
}

}  // namespace

SyntheticGround::SyntheticGround(Image texture, double texel_m, double relief_m)
    : texel_m_(texel_m), relief_m_(relief_m) {
  mips_.push_back(std::move(texture));
  while (std::min(mips_.back().width_px, mips_.back().height_px) >= 16) {
    mips_.push_back(halved(mips_.back()));
  }
}

SyntheticGround SyntheticGround::procedural(std::uint64_t seed,
                                            int size_px,
                                            double texel_m,
                                            double relief_m) {
  std::mt19937_64 rng(seed);
  const auto uniform = [&] { return static_cast<double>(rng() >> 11U) * 0x1.0p-53; };
  std::vector<float> grey(static_cast<std::size_t>(size_px) * size_px, 110.0F);
  // Rectangles of every size from fields to stones, each with its own furrows.
  for (double side = size_px / 6.0; side > 2.5; side /= 1.5) {
    const int count = static_cast<int>(0.5 * size_px * size_px / (side * side));
    for (int i = 0; i < count; ++i) {
      const int x = static_cast<int>(uniform() * size_px);
      const int y = static_cast<int>(uniform() * size_px);
      const int w = static_cast<int>(side * (0.4 + uniform()));
      const int h = static_cast<int>(side * (0.4 + uniform()));
      const auto tone = static_cast<float>(60.0 * (uniform() - 0.5));
      const double period = 4.0 + 20.0 * uniform();
      for (int dy = 0; dy < h; ++dy) {
        for (int dx = 0; dx < w; ++dx) {
          const auto at =
              static_cast<std::size_t>((y + dy) % size_px) * size_px + (x + dx) % size_px;
          const auto furrow = static_cast<float>(6.0 * std::sin(6.28 * dx / period));
          grey[at] += tone + furrow - 0.3F * (grey[at] - 110.0F);
        }
      }
    }
  }
  Image texture(size_px, size_px, 1);
  std::transform(grey.begin(), grey.end(), texture.data.begin(), [](float value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F));
  });
  return {std::move(texture), texel_m, relief_m};
}

double SyntheticGround::height_m(double east_m, double north_m) const {
  if (relief_m_ == 0.0) return 0.0;
  return 0.5 * relief_m_ *
         (std::sin(east_m / 90.0) * std::cos(north_m / 110.0) +
          std::sin((east_m + north_m) / 60.0));
}

float SyntheticGround::sample(double east_m, double north_m, double footprint_m) const {
  const double level = std::max(0.0F, std::log2(static_cast<float>(footprint_m / texel_m_)));
  const auto fine = std::min(static_cast<std::size_t>(level), mips_.size() - 1);
  const std::size_t coarse = std::min(fine + 1, mips_.size() - 1);
  const auto at = [&](std::size_t mip) {
    const double size = texel_m_ * static_cast<double>(std::uint64_t{1} << mip);
    return bilinear_repeated(mips_[mip], east_m / size - 0.5, -north_m / size - 0.5);
  };
  const auto share = static_cast<float>(std::min(1.0, level - static_cast<double>(fine)));
  return (1.0F - share) * at(fine) + (share > 0.0F ? share * at(coarse) : 0.0F);
}

const std::vector<Eigen::Vector3d>& SyntheticGround::rays_of(const CameraModel& camera) const {
  const PinholeCamera& pinhole = camera.pinhole();
  const PinholeCamera& known = rays_camera_.pinhole();
  if (!rays_.empty() && pinhole.K() == known.K() && pinhole.width_px == known.width_px &&
      pinhole.height_px == known.height_px &&
      camera.distortion().model == rays_camera_.distortion().model &&
      camera.distortion().k == rays_camera_.distortion().k) {
    return rays_;
  }
  rays_camera_ = camera;
  rays_.clear();
  for (int y = 0; y < pinhole.height_px; ++y) {
    for (int x = 0; x < pinhole.width_px; ++x) {
      rays_.push_back(camera.ray(Eigen::Vector2d(x, y)).value());
    }
  }
  return rays_;
}

Image SyntheticGround::render(const CameraModel& camera_model,
                              const Pose& T_world_camera,
                              double noise,
                              std::uint64_t noise_seed) const {
  const PinholeCamera& camera = camera_model.pinhole();
  const std::vector<Eigen::Vector3d>& rays = rays_of(camera_model);
  Image image(camera.width_px, camera.height_px, 1, 200);
  std::mt19937_64 rng(noise_seed);
  const Eigen::Matrix3d R = T_world_camera.rotation.toRotationMatrix();
  const Eigen::Vector3d& eye = T_world_camera.translation;
  double ground_m = 0.0;  // height of the ground at the previous pixel
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d ray =
          R * rays[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width_px) +
                   static_cast<std::size_t>(x)];
      if (ray.z() > -0.02) continue;  // sky
      double along = (ground_m - eye.z()) / ray.z();
      if (relief_m_ != 0.0) {
        for (int i = 0; i < 6; ++i) {
          const double before_m = ground_m;
          ground_m = height_m(eye.x() + along * ray.x(), eye.y() + along * ray.y());
          along = (ground_m - eye.z()) / ray.z();
          if (std::abs(ground_m - before_m) < 1e-3) break;
        }
      }
      // The footprint of a pixel, mean of along and across the slope.
      const double footprint = along * ray.norm() / camera.fx_px / std::sqrt(-ray.z() / ray.norm());
      float value = sample(eye.x() + along * ray.x(), eye.y() + along * ray.y(), footprint);
      if (noise > 0.0) {
        // Sum of four uniforms: variance 1/3.
        const std::uint64_t bits = rng();
        const double sum = static_cast<double>((bits & 0xffffU) + ((bits >> 16U) & 0xffffU) +
                                               ((bits >> 32U) & 0xffffU) + (bits >> 48U)) /
                               65535.0 -
                           2.0;
        value += static_cast<float>(noise * 1.732 * sum);
      }
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    }
  }
  return image;
}

std::vector<Pose> fly_s_turns(const SyntheticFlightOptions& options) {
  std::vector<Pose> poses;
  const double step_s = 1.0 / (options.rate_hz * 16.0);
  Eigen::Vector3d position(0.0, 0.0, options.height_m);
  double yaw = 0.3;
  const auto frames = static_cast<int>(options.duration_s * options.rate_hz);
  for (int i = 0; i < frames * 16; ++i) {
    const double bank = bank_at(options, i * step_s);
    if (i % 16 == 0) {
      poses.push_back({R_world_body_from({bank, 0.0, yaw}) * R_body_camera_nadir(), position});
    }
    position += step_s * options.speed_m_s * Eigen::Vector3d(std::sin(yaw), std::cos(yaw), 0.0);
    yaw += step_s * kGravity * std::tan(bank) / options.speed_m_s;
  }
  return poses;
}

}  // namespace overfly::odometry::testing
