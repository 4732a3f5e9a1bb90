// The parts of an image and what is sampled from them: every pixel once, its own ray, exact
// where the interpolation is.
#include "renderer/camera/image_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "renderer/camera/part_sampling.hpp"

namespace overfly::renderer {
namespace {

PinholeCamera wide_pinhole() { return {333, 301, 210.0, 220.0, 150.0, 160.0}; }

CameraRequest parts_request(DistortionModel model, RenderQuality quality) {
  CameraRequest request;
  Distortion distortion{model, {}};
  if (model == DistortionModel::kRadtan) distortion.k = {-0.2, 0.05, 1e-3, -1e-3, 0.0};
  if (model == DistortionModel::kEquidistant) distortion.k = {0.01, -0.005, 0.0, 0.0};
  if (model == DistortionModel::kFov) distortion.k = {0.9};
  request.camera = CameraModel(wide_pinhole(), distortion);
  request.quality = quality;
  request.t_ns = 1'000'000;
  request.readout_ns = 300'000;
  return request;
}

constexpr DistortionModel kModels[] = {DistortionModel::kNone,
                                       DistortionModel::kRadtan,
                                       DistortionModel::kEquidistant,
                                       DistortionModel::kFov};
constexpr RenderQuality kQualities[] = {RenderQuality::kTrilinear, RenderQuality::kReference};

TEST(ImageParts, CoverEveryPixelOnceAtTheTimeOfTheirMiddleRow) {
  for (const DistortionModel model : kModels) {
    for (const int rows : {17, 100, 301}) {
      const CameraRequest request = parts_request(model, RenderQuality::kTrilinear);
      std::vector<int> covered(333 * 301, 0);
      for (const ImagePart& part : divide_image(request, rows)) {
        EXPECT_LE(part.height_px, rows);
        // 1 us from row to row.
        EXPECT_NEAR(static_cast<double>(part.t_ns),
                    850'000.0 + 1000.0 * (part.top_px + 0.5 * (part.height_px - 1)),
                    1.0);
        for (int y = part.top_px; y < part.top_px + part.height_px; ++y) {
          for (int x = part.left_px; x < part.left_px + part.width_px; ++x) {
            ++covered.at(y * 333 + x);
          }
        }
      }
      EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), 333 * 301);
    }
  }
}

TEST(ImageParts, HoldTheTapsOfAllTheirPixelsDenselyEnough) {
  for (const DistortionModel model : kModels) {
    for (const RenderQuality quality : kQualities) {
      const CameraRequest request = parts_request(model, quality);
      for (const ImagePart& part : divide_image(request, 64)) {
        if (part.direct) continue;
        for (int y = 0; y < part.height_px; y += 3) {
          for (int x = 0; x < part.width_px; x += 3) {
            const Eigen::Vector2d pixel(part.left_px + x, part.top_px + y);
            const auto at = [&](double dx, double dy) {
              return source_pixel(part, *request.camera.ray(pixel + Eigen::Vector2d(dx, dy)));
            };
            for (const Eigen::Vector2d& tap : pixel_taps(quality)) {
              const Eigen::Vector2d place = at(tap.x(), tap.y());
              // With the neighbours that the cubic kernel reads, unless the source ends there.
              const double room = model == DistortionModel::kNone ? 0.0 : 1.0;
              ASSERT_GE(place.minCoeff(), room - 1e-9);
              ASSERT_LE(place.x(), part.source.width_px - 1 - room + 1e-9);
              ASSERT_LE(place.y(), part.source.height_px - 1 - room + 1e-9);
            }
            ASSERT_GE((at(0.5, 0.0) - at(-0.5, 0.0)).norm(), 0.97 * kOversampling);
            ASSERT_GE((at(0.0, 0.5) - at(0.0, -0.5)).norm(), 0.97 * kOversampling);
          }
        }
      }
    }
  }
}

TEST(ImageParts, WithoutALensArePixelsOfTheirSource) {
  for (const ImagePart& part :
       divide_image(parts_request(DistortionModel::kNone, RenderQuality::kTrilinear), 50)) {
    EXPECT_TRUE(part.direct);
    const Eigen::Vector2d inside(17.0, 3.0);
    const Eigen::Vector2d pixel = inside + Eigen::Vector2d(part.left_px, part.top_px);
    EXPECT_LT((part.source.ray(inside) - wide_pinhole().ray(pixel)).norm(), 1e-12);
  }
  // The taps of the reference quality are the pixels of a picture twice as dense.
  for (const ImagePart& part :
       divide_image(parts_request(DistortionModel::kNone, RenderQuality::kReference), 50)) {
    EXPECT_FALSE(part.direct);
    const auto taps = pixel_taps(RenderQuality::kReference);
    for (std::size_t i = 0; i < taps.size(); ++i) {
      const Eigen::Vector2d pixel = Eigen::Vector2d(part.left_px + 5, part.top_px + 1) + taps[i];
      const Eigen::Vector2d place = source_pixel(part, wide_pinhole().ray(pixel));
      EXPECT_LT((place - Eigen::Vector2d(10 + (i & 1), 2 + (i >> 1))).norm(), 1e-9);
    }
  }
}

TEST(ImageParts, CoveringPinholeSeesEveryRay) {
  for (const DistortionModel model : kModels) {
    const CameraModel camera = parts_request(model, RenderQuality::kTrilinear).camera;
    const PinholeCamera wide = covering_pinhole(camera);
    EXPECT_EQ(wide.fx_px, camera.pinhole().fx_px);
    for (int y = 0; y < 301; y += 5) {
      for (const double x : {-0.5, 0.0, 90.0, 332.0, 332.5}) {
        const auto seen = wide.project(*camera.ray({x, static_cast<double>(y)}));
        ASSERT_TRUE(seen.has_value());
        ASSERT_TRUE(seen->minCoeff() >= -0.5 && seen->x() <= wide.width_px - 0.5 &&
                    seen->y() <= wide.height_px - 0.5);
      }
    }
  }
}

/// A picture of a part whose values are a function of the place.
template <typename F>
ImageBuffer<float> picture_of(const ImagePart& part, const F& f) {
  ImageBuffer<float> picture(part.source.width_px, part.source.height_px, 1);
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) picture.at(x, y) = static_cast<float>(f(x, y));
  }
  return picture;
}

TEST(PartSampling, ReproducesQuadraticsAndWeighs) {
  // Keys 1981: the kernel with a = -1/2 is exact for polynomials of the second degree.
  const auto quadratic = [](double x, double y) {
    return 500.0 + 0.3 * x - 0.2 * y + 0.002 * x * x - 0.001 * x * y + 0.003 * y * y;
  };
  for (const RenderQuality quality : kQualities) {
    const CameraRequest request = parts_request(DistortionModel::kRadtan, quality);
    const TapRays rays(request.camera, quality);
    EXPECT_TRUE(rays.fits(request.camera, quality));
    EXPECT_FALSE(rays.fits(wide_pinhole(), quality));
    ImageBuffer<float> image(333, 301, 1);
    for (const ImagePart& part : divide_image(request, 100)) {
      const ImageBuffer<float> picture = picture_of(part, quadratic);
      add_part(part, picture, rays, 0.75F, image);
      add_part(part, picture, rays, 0.25F, image);
      for (int y = 0; y < part.height_px; y += 5) {
        for (int x = 0; x < part.width_px; x += 5) {
          double expected = 0.0;
          const auto taps = pixel_taps(quality);
          for (const Eigen::Vector2d& tap : taps) {
            const Eigen::Vector2d pixel = Eigen::Vector2d(part.left_px + x, part.top_px + y) + tap;
            const Eigen::Vector2d at = source_pixel(part, *request.camera.ray(pixel));
            expected += quadratic(at.x(), at.y()) / static_cast<double>(taps.size());
          }
          // Rays are kept as floats: 1e-4 px of slopes of a few.
          ASSERT_NEAR(image.at(part.left_px + x, part.top_px + y), expected, 4e-3);
        }
      }
    }
  }
}

TEST(PartSampling, LightIsNeverNegative) {
  const CameraRequest request = parts_request(DistortionModel::kFov, RenderQuality::kTrilinear);
  const TapRays rays(request.camera, request.quality);
  ImageBuffer<float> image(333, 301, 1);
  for (const ImagePart& part : divide_image(request, 301)) {
    // A step, next to which the cubic kernel undershoots.
    add_part(part, picture_of(part, [](int x, int) { return x % 40 < 20; }), rays, 1.0F, image);
  }
  EXPECT_GE(*std::min_element(image.data.begin(), image.data.end()), 0.0F);
  EXPECT_GT(*std::max_element(image.data.begin(), image.data.end()), 1.0F);
}

TEST(PartSampling, DepthIsExactOnPlanesAndNeverMixedAtEdges) {
  const CameraRequest request =
      parts_request(DistortionModel::kEquidistant, RenderQuality::kTrilinear);
  const TapRays rays(request.camera, request.quality);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, 1.0).normalized();  // n . p = 100 m
  DepthImage plane(333, 301, 1), edge(333, 301, 1);
  for (const ImagePart& part : divide_image(request, 301)) {
    const Eigen::Vector3d normal_source = part.R_source_camera * normal;
    write_depth(part,
                picture_of(part,
                           [&](int x, int y) {
                             return 100.0 / normal_source.dot(part.source.ray({x, y}));
                           }),
                rays,
                plane);
    const auto step = [](int x, int) {
      return x % 30 < 15 ? 80.0F : (x % 60 < 30 ? 200.0F : std::numeric_limits<float>::infinity());
    };
    write_depth(part, picture_of(part, step), rays, edge);
    for (int y = part.top_px; y < part.top_px + part.height_px; y += 2) {
      for (int x = part.left_px; x < part.left_px + part.width_px; x += 2) {
        const Eigen::Vector3d ray = *request.camera.ray({x, y});
        const double expected = 100.0 / normal.dot(ray);
        ASSERT_NEAR(plane.at(x, y), expected, 1e-4 * expected);
        const double along = edge.at(x, y) * (part.R_source_camera * ray).z();
        ASSERT_TRUE(std::isinf(along) || std::abs(along - 80.0) < 0.01 ||
                    std::abs(along - 200.0) < 0.01)
            << along;
      }
    }
  }
}

}  // namespace
}  // namespace overfly::renderer
