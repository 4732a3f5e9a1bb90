// A renderer without graphics: the same checks and metadata as a real one, and images that are a
// pattern of their pose.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "renderer/camera/frame_statistics.hpp"
#include "renderer/camera/image_parts.hpp"
#include "renderer/ground/ground_mesh.hpp"
#include "renderer/renderer.hpp"
#include "renderer/request_check.hpp"

namespace overfly::renderer {

namespace {

/// Stripes whose phase and direction depend on the pose: equal poses give equal images, and a
/// moving camera gives moving ones.
Image pose_pattern(int width_px, int height_px, int channels, const Pose& pose) {
  const Eigen::Vector3d& p = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  const double phase = p.x() + 3.0 * p.y() + 7.0 * p.z() + 40.0 * q.x() + 90.0 * q.y();
  const int offset = static_cast<int>(std::lround(std::fmod(8.0 * phase, 65536.0)));
  const int slope = 1 + (static_cast<int>(std::lround(50.0 * std::abs(q.z()))) & 7);
  Image image(width_px, height_px, channels);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const auto value = static_cast<std::uint8_t>(x + slope * y + offset);
      for (int c = 0; c < channels; ++c) {
        image.at(x, y, c) = static_cast<std::uint8_t>(value + 40 * c);
      }
    }
  }
  return image;
}

RadianceImage radiance_of(const Image& image) {
  RadianceImage radiance(image.width_px, image.height_px, image.channels);
  std::transform(image.data.begin(), image.data.end(), radiance.data.begin(), [](std::uint8_t v) {
    return static_cast<float>(v) / 255.0F;
  });
  return radiance;
}

class NoopRenderer final : public Renderer {
 public:
  explicit NoopRenderer(std::shared_ptr<const terrain::TileSource> tiles)
      : tiles_(std::move(tiles)), patches_(tiles_) {}

  using Renderer::render_camera;
  using Renderer::render_depth;

  Result<CameraFrame> render_camera(const CameraRequest& request) override {
    if (Status s = check_camera_request(*tiles_, request); !s) return s.error();
    const PinholeCamera& camera = request.camera.pinhole();
    CameraFrame frame;
    frame.t_ns = request.t_ns;
    frame.T_world_camera = request.T_world_camera.at(request.t_ns);
    frame.camera = request.camera;
    frame.image = pose_pattern(
        camera.width_px, camera.height_px, channel_count(request.format), frame.T_world_camera);
    if (is_linear(request.format)) {
      frame.radiance = radiance_of(frame.image);
      frame.image = {};
    }
    const View view = View::from(covering_pinhole(request.camera), frame.T_world_camera);
    const GroundMesh mesh = build_ground_mesh(patches_, view, {});
    const FrameStatistics statistics =
        measure_frame(mesh, view, request.camera, *tiles_, imagery_query(*tiles_));
    frame.texels_per_pixel_min = statistics.texels_per_pixel_min;
    frame.texels_per_pixel_median = statistics.texels_per_pixel_median;
    frame.void_fraction = statistics.void_fraction;
    frame.axis_depth_m = statistics.axis_depth_m;
    if (Status s = tiles_->status(); !s) return s.error();
    return frame;
  }

  /// Depth of the level plane through the ground below the camera.
  Result<DepthImage> render_depth(const CameraRequest& request) override {
    if (Status s = check_camera_request(*tiles_, request); !s) return s.error();
    const PinholeCamera& camera = request.camera.pinhole();
    const View view = View::from(camera, request.T_world_camera.at(request.t_ns));
    const Eigen::Vector3d& p = view.position_world;
    const double height_m = p.z() - tiles_->ground_up_m(p.x(), p.y());
    const Eigen::Vector3d down_camera = -view.R_camera_world.col(2);
    DepthImage depth(camera.width_px, camera.height_px, 1);
    for (int y = 0; y < camera.height_px; ++y) {
      for (int x = 0; x < camera.width_px; ++x) {
        const double descent = down_camera.dot(camera.ray({x, y}));
        depth.at(x, y) = descent > 1e-6 && height_m > 0.0 ? static_cast<float>(height_m / descent)
                                                          : std::numeric_limits<float>::infinity();
      }
    }
    if (Status s = tiles_->status(); !s) return s.error();
    return depth;
  }

  Result<Image> render_scene(const SceneView& view, const SceneContent& /*content*/) override {
    const Result<PinholeCamera> camera = camera_of(view);
    if (!camera.ok()) return camera.error();
    return pose_pattern(view.width_px, view.height_px, 3, view.T_world_camera);
  }

  [[nodiscard]] RendererInfo info() const override {
    return {"noop", "none", "none", true, "", ""};
  }

 private:
  std::shared_ptr<const terrain::TileSource> tiles_;
  GroundPatches patches_;
};

}  // namespace

std::unique_ptr<Renderer> create_noop_renderer(std::shared_ptr<const terrain::TileSource> tiles) {
  return std::make_unique<NoopRenderer>(std::move(tiles));
}

}  // namespace overfly::renderer
