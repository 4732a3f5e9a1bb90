// Samples an image from the pinhole images of its parts.
//
// Method: a pixel is the mean of its taps (pixel_taps). A tap at the centre of a pinhole image's
// pixel takes its value; others are interpolated by cubic convolution (Keys, Cubic convolution
// interpolation for digital image processing, IEEE Trans. ASSP 29, 1981, eq. 15) over 4 x 4 pixels
// of an image that is kOversampling times as dense as the result.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "renderer/camera/image_parts.hpp"

namespace overfly::renderer {

/// The rays of all taps of all pixels, computed once for a camera.
class TapRays {
 public:
  TapRays(const CameraModel& camera, RenderQuality quality);

  [[nodiscard]] bool fits(const CameraModel& camera, RenderQuality quality) const;
  [[nodiscard]] int taps() const { return static_cast<int>(taps_.size()); }
  /// Direction (x, y, 1); NaN where the camera has no ray.
  [[nodiscard]] Eigen::Vector3d ray(int x, int y, int tap) const;

 private:
  CameraModel camera_;
  RenderQuality quality_;
  std::vector<Eigen::Vector2d> taps_;
  std::vector<Eigen::Vector2f> plane_;  // for a lens
};

/// Adds weight times a part's image to its rectangle of the result. Pixels without a ray are
/// unchanged.
void add_part(const ImagePart& part,
              const ImageBuffer<float>& picture,
              const TapRays& rays,
              float weight,
              ImageBuffer<float>& image);

/// Writes the depth along the camera's axis in a part's rectangle, from the depth along the pinhole
/// image's axis: interpolated on planes, the nearest sample's at edges.
void write_depth(const ImagePart& part,
                 const DepthImage& picture,
                 const TapRays& rays,
                 DepthImage& depth);

}  // namespace overfly::renderer
