// The camera's self-test: depth and pose must map one image onto the next.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "renderer/probes/registration.hpp"
#include "server/camera/renderer_factory.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

struct CameraCheckOptions {
  int pairs = 4;          ///< pairs of successive frames, spread over the flight; in [1, 1000]
  double limit_px = 0.1;  ///< for the median distance between predicted and observed patches, > 0
  RendererFactory renderer_factory;  ///< the scenario's renderer if empty
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string&)> notice;

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// One pair of frames of one camera.
struct CameraCheckPair {
  std::int64_t frame = 0;  ///< index of the first of the two
  renderer::Registration residual;
};

/// One camera.
struct CameraCheckRow {
  std::string camera;
  std::string backend;  ///< the renderer that drew it
  std::vector<CameraCheckPair> pairs;
  double worst_median_px = 0.0;
  double worst_p95_px = 0.0;
  double worst_lost_share = 0.0;  ///< share of patches that were not found in the other image
  int fewest_patches = 0;
  std::string fault;  ///< the quantity that exceeds its limit; empty = passed
};

/// Draws pairs of successive frames through lens and shutter, but without sensor and faults. Warps
/// the second image along the flow (optical_flow of the first image's world points) and matches its
/// patches in the first image. The test measures the distance between the images: an error in
/// depth, pose, lens or row time appears in pixels. Interpolation itself causes an error of up to
/// 0.03 px, which varies as a sine of the motion's fraction of a pixel (Schreier, Braasch, Sutton
/// 2000, Opt. Eng. 39(11)). A pair also fails if it has fewer than 20 textured patches or if more
/// than 5 % of them are not found.
/// Errors: as FrameMaker; kInvalidArgument for a flight of fewer than two frames; kCancelled.
[[nodiscard]] Result<std::vector<CameraCheckRow>> check_camera(const Scenario& scenario,
                                                               const CameraCheckOptions& options);

/// The default scenario of the test: a small landscape made in `folder`, flown in straight, turning
/// and rolling flight by a pinhole camera and by a camera with lens and rolling shutter.
/// Errors: as synthesize_world.
[[nodiscard]] Result<Scenario> camera_check_scenario(const std::filesystem::path& folder);

}  // namespace overfly::server
