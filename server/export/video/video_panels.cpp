#include "server/export/video/video_panels.hpp"

#include <algorithm>

#include "renderer/viewpoint.hpp"

namespace overfly::server {

Image panel_from(const Image& image, int factor) {
  const int width = image.width_px / factor / 2 * 2;
  const int height = image.height_px / factor / 2 * 2;
  Image panel(width, height, 3);
  const int samples = factor * factor;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int channel = image.channels == 3 ? c : 0;
        int sum = samples / 2;
        for (int j = 0; j < factor; ++j) {
          for (int i = 0; i < factor; ++i) sum += image.at(factor * x + i, factor * y + j, channel);
        }
        panel.at(x, y, c) = static_cast<std::uint8_t>(sum / samples);
      }
    }
  }
  return panel;
}

Image side_by_side(const Image& left, const Image& right) {
  Image both(left.width_px + right.width_px, left.height_px, 3);
  for (int y = 0; y < both.height_px; ++y) {
    std::copy_n(&left.at(0, y), 3 * static_cast<std::size_t>(left.width_px), &both.at(0, y));
    std::copy_n(
        &right.at(0, y), 3 * static_cast<std::size_t>(right.width_px), &both.at(left.width_px, y));
  }
  return both;
}

ChasePanel::ChasePanel(renderer::Renderer& renderer, const HeightQuery& ground, double wing_span_m)
    : renderer_(renderer), ground_(ground), wing_span_m_(wing_span_m) {}

Result<Image> ChasePanel::draw(const Pose& T_world_body, int width_px, int height_px) {
  constexpr std::size_t kRibbonPoses = 2000;
  flown_.push_back(T_world_body);
  if (flown_.size() > kRibbonPoses) flown_.erase(flown_.begin());
  renderer::SceneView view;
  view.width_px = width_px;
  view.height_px = height_px;
  view.T_world_camera = renderer::chase_viewpoint(T_world_body, {}, ground_);
  renderer::SceneContent content;
  content.aircraft.push_back({T_world_body, {0.9F, 0.1F, 0.1F}, wing_span_m_, false});
  if (flown_.size() > 1) {
    content.ribbons.push_back({{1.0F, 0.2F, 0.1F}, wing_span_m_, flown_});
  }
  return renderer_.render_scene(view, content);
}

}  // namespace overfly::server
