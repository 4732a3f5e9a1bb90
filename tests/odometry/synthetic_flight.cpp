#include "tests/odometry/synthetic_flight.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <utility>

#include "tests/odometry/grey_noise.hpp"

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

/// Hills and valleys, from -1 to 1.
template <typename Real>
Real relief_at(Real east_m, Real north_m) {
  return Real(0.5) *
         (std::sin(east_m / 90) * std::cos(north_m / 110) + std::sin((east_m + north_m) / 60));
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
  mips_.push_back({std::move(texture), 1.0 / texel_m});
  while (std::min(mips_.back().image.width_px, mips_.back().image.height_px) >= 16) {
    mips_.push_back({halved(mips_.back().image), 0.5 * mips_.back().per_m});
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
  return relief_m_ * relief_at(east_m, north_m);
}

float SyntheticGround::sample(double east_m, double north_m, double footprint_m) const {
  const auto texels = std::max(1.0F, static_cast<float>(footprint_m / texel_m_));
  // Between powers of two the share of the coarser level grows in proportion to the footprint.
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(texels);
  const std::size_t fine = std::min<std::size_t>((bits >> 23U) - 127U, mips_.size() - 1);
  const float share = fine + 1 < mips_.size()
                          ? std::bit_cast<float>((bits & 0x7fffffU) | 0x3f800000U) - 1.0F
                          : 0.0F;
  const auto at = [&](const Mip& mip) {
    return bilinear_repeated(mip.image, east_m * mip.per_m - 0.5, -north_m * mip.per_m - 0.5);
  };
  const float grey = at(mips_[fine]);
  return share > 0.0F ? grey + share * (at(mips_[fine + 1]) - grey) : grey;
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
      rays_.push_back(camera.ray(Eigen::Vector2d(x, y)).value().normalized());
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
  GreyNoise grey_noise(noise, noise_seed);
  const Eigen::Matrix3d R = T_world_camera.rotation.toRotationMatrix();
  const Eigen::Vector3d& eye = T_world_camera.translation;
  const double per_focal = 1.0 / camera.fx_px;
  double ground_m = 0.0;  // height of the ground at the previous pixel
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d ray = R * rays[i];
    if (ray.z() > -0.02) continue;  // sky
    double along = (ground_m - eye.z()) / ray.z();
    if (relief_m_ != 0.0) {
      for (int round = 0; round < 6; ++round) {
        const double before_m = ground_m;
        // Single precision is right to a tenth of a millimetre.
        ground_m = relief_m_ * relief_at(static_cast<float>(eye.x() + along * ray.x()),
                                         static_cast<float>(eye.y() + along * ray.y()));
        along = (ground_m - eye.z()) / ray.z();
        if (std::abs(ground_m - before_m) < 1e-3) break;
      }
    }
    // The footprint of a pixel, mean of along and across the slope.
    const double footprint_m = along * per_focal / std::sqrt(static_cast<float>(-ray.z()));
    float value = sample(eye.x() + along * ray.x(), eye.y() + along * ray.y(), footprint_m);
    if (noise > 0.0) value += grey_noise();
    image.data[i] = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
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
