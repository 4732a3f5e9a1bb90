// The images that a video is composed of.
#pragma once

#include <vector>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "server/camera/frame_maker.hpp"

namespace overfly::server {

/// The image as RGB, downsampled by an integer factor (mean of the pixels); its sides are cropped
/// to even numbers.
[[nodiscard]] Image panel_from(const Image& image, int factor);

/// Two RGB images of the same height side by side.
[[nodiscard]] Image side_by_side(const Image& left, const Image& right);

/// The aircraft from behind, with its path so far.
class ChasePanel {
 public:
  /// @param wing_span_m  > 0. The references must outlive the panel.
  ChasePanel(renderer::Renderer& renderer, const HeightQuery& ground, double wing_span_m = 8.0);

  /// Errors: as render_scene.
  [[nodiscard]] Result<Image> draw(const Pose& T_world_body, int width_px, int height_px);

 private:
  renderer::Renderer& renderer_;
  const HeightQuery& ground_;
  double wing_span_m_;
  std::vector<Pose> flown_;  ///< T_world_body so far
};

}  // namespace overfly::server
