#include "tests/calibration/sample_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace overfly::calibration {

CameraModel pinhole_camera() { return PinholeCamera{640, 480, 520.0, 523.0, 322.0, 236.5}; }

CameraModel radtan_camera() {
  return {PinholeCamera{640, 480, 452.3, 449.8, 326.4, 233.1},
          {DistortionModel::kRadtan, {-0.27, 0.07, 0.0008, -0.0006, 0.0}}};
}

CameraModel equidistant_camera() {
  return {PinholeCamera{640, 480, 355.0, 356.5, 316.2, 243.7},
          {DistortionModel::kEquidistant, {0.02, -0.01, 0.004, -0.001, 0.0}}};
}

std::vector<BoardView> exact_views(const CameraModel& camera,
                                   const Board& board,
                                   const std::vector<Pose>& T_camera_board,
                                   double noise_px,
                                   std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<BoardView> views;
  for (const Pose& pose : T_camera_board) {
    BoardView view;
    for (int id = 0; id < board.corner_count(); ++id) {
      const Eigen::Vector2d at_m = board.corner_m(id);
      const auto pixel = camera.project(pose * Eigen::Vector3d(at_m.x(), at_m.y(), 0.0));
      const double dx = noise_px * noise(random);
      const double dy = noise_px * noise(random);
      view.corners.push_back({id, pixel.value() + Eigen::Vector2d(dx, dy)});
    }
    views.push_back(std::move(view));
  }
  return views;
}

RadianceImage slightly_blurred(const RadianceImage& sharp) {
  RadianceImage blurred = sharp;
  for (int y = 1; y + 1 < sharp.height_px; ++y) {
    for (int x = 1; x + 1 < sharp.width_px; ++x) {
      float sum = 0.0F;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          sum += sharp.at(x + dx, y + dy) *
                 static_cast<float>((2 - std::abs(dx)) * (2 - std::abs(dy)));
        }
      }
      blurred.at(x, y) = sum / 16.0F;
    }
  }
  return blurred;
}

Image grey_from(const RadianceImage& radiance) {
  Image image(radiance.width_px, radiance.height_px, 1);
  std::transform(radiance.data.begin(), radiance.data.end(), image.data.begin(), [](float value) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(255.0F * value), 0L, 255L));
  });
  return image;
}

}  // namespace overfly::calibration
