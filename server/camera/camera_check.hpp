// The camera's self-test: depth and pose must take one image onto the next.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "renderer/registration.hpp"
#include "server/camera/renderer_factory.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::engine {

struct CameraCheckOptions {
  int pairs = 4;          ///< of successive frames, spread over the flight; in [1, 1000]
  double limit_px = 0.1;  ///< of the median distance between predicted and seen patches, > 0
  RendererFactory renderer_factory;  ///< the scenario's renderer where it is empty
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string&)> notice;

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// One pair of frames of one camera.
struct CameraCheckPair {
  std::int64_t frame = 0;  ///< the first of the two
  renderer::Registration residual;
};

/// One camera.
struct CameraCheckRow {
  std::string camera;
  std::string backend;  ///< that drew it
  std::vector<CameraCheckPair> pairs;
  double worst_median_px = 0.0;
  double worst_p95_px = 0.0;
  double worst_lost_share = 0.0;  ///< of patches that were not found again
  int fewest_patches = 0;
  std::string fault;  ///< what exceeds its limit; empty = passed
};

/// Draws pairs of successive frames without sensor and faults, but through lens and shutter, takes
/// the second along the flow (optical_flow of the first's world points) and finds its patches in
/// the first. What is measured is the images' distance: an error in depth, pose, lens or row time
/// shows as pixels. Interpolation alone misplaces by up to 0.03 px, as a sine of the motion's
/// fraction of a pixel (Schreier, Braasch, Sutton 2000, Opt. Eng. 39(11)). A pair with fewer than
/// 20 textured patches, or with more than 5 % of them not found again, is a fault too. Errors: as
/// FrameMaker's; kInvalidArgument for a flight of fewer than two frames; kCancelled.
[[nodiscard]] Result<std::vector<CameraCheckRow>> check_camera(const Scenario& scenario,
                                                               const CameraCheckOptions& options);

/// The scenario of the test where none is named: a small landscape made in `folder`, flown in
/// straight, turning and rolling flight by a pinhole and by a camera with lens and rolling shutter.
/// Errors: as synthesize_world.
[[nodiscard]] Result<Scenario> camera_check_scenario(const std::filesystem::path& folder);

}  // namespace overfly::engine
