#include "odometry/image/pyramid.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/odometry/synthetic_flight.hpp"

namespace overfly::odometry {
namespace {

using testing::SyntheticGround;

TEST(Burnt, AreasAreFoundAndWhiteRoofsAreNot) {
  auto image = std::make_shared<Image>(640, 480, 1, std::uint8_t{90});
  const auto paint = [&](int x0, int y0, int side) {
    for (int y = y0; y < y0 + side; ++y) {
      for (int x = x0; x < x0 + side; ++x) image->at(x, y) = 255;
    }
  };
  for (int roof = 0; roof < 30; ++roof) paint(10 + 20 * roof, 20, 14);
  EXPECT_TRUE(build_pyramid(image, true).burnt.empty());
  paint(300, 200, 100);
  EXPECT_TRUE(build_pyramid(image).burnt.empty());
  const Pyramid pyramid = build_pyramid(image, true);
  EXPECT_TRUE(pyramid.burnt_at({350.0, 250.0}));
  EXPECT_TRUE(pyramid.burnt_at({300.0, 200.0}));
  EXPECT_TRUE(pyramid.burnt_at({399.0, 299.0}));
  EXPECT_FALSE(pyramid.burnt_at({270.0, 250.0}));
  EXPECT_FALSE(pyramid.burnt_at({15.0, 25.0}));
  EXPECT_FALSE(pyramid.burnt_at({639.0, 479.0}));
}

/// Ground as a camera of 640x480 sees it from above.
Image ground_from(double height_m, double noise) {
  const auto camera = PinholeCamera::from_fov(640, 480, 1.48, FovAxis::kHorizontal).value();
  const Pose T_world_camera{Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), {10.0, 20.0, height_m}};
  return SyntheticGround::procedural(3, 512, 0.8, 0.0).render(camera, T_world_camera, noise, 7);
}

/// What is left of a picture in the dark, and read noise as a response of steep foot shows it.
Image dimmed(Image image, double share_left, double noise) {
  std::mt19937 rng(5);
  std::normal_distribution<double> read(0.0, noise);
  for (std::uint8_t& value : image.data) {
    const double dim = share_left * value + read(rng);
    value = static_cast<std::uint8_t>(std::clamp(dim, 0.0, 255.0));
  }
  return image;
}

bool shown_by(Image image) {
  return shows_something(build_pyramid(std::make_shared<const Image>(std::move(image))));
}

TEST(ShowsSomething, GroundFromAnyHeight) {
  for (const double height_m : {20.0, 50.0, 300.0}) {
    EXPECT_TRUE(shown_by(ground_from(height_m, 1.5))) << height_m;
  }
  EXPECT_TRUE(shown_by(dimmed(ground_from(300.0, 0.0), 0.3, 3.0))) << "dusk";
}

TEST(ShowsSomething, NotNoiseNorNothing) {
  EXPECT_FALSE(shown_by(dimmed(ground_from(300.0, 0.0), 0.0, 15.0)));
  EXPECT_FALSE(shown_by(dimmed(Image(320, 240, 1), 0.0, 15.0)));
  EXPECT_FALSE(shown_by(Image(640, 480, 1, 255)));
}

}  // namespace
}  // namespace overfly::odometry
