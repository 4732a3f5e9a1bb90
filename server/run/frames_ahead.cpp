#include "server/run/frames_ahead.hpp"

#include <algorithm>

namespace overfly::server {

std::uint64_t frame_bytes(const Scenario& scenario) {
  std::uint64_t bytes = 0;
  for (const CameraSpec& camera : scenario.cameras) {
    const PinholeCamera& pinhole = camera.model.pinhole();
    const auto pixels = static_cast<std::uint64_t>(pinhole.width_px) *
                        static_cast<std::uint64_t>(pinhole.height_px);
    const std::uint64_t image = pixels * (camera.rgb ? 3 : 1);
    bytes += image;
    if (camera.rgb) bytes += pixels;
    if (camera.sensor.enabled && camera.sensor.bits > 8) bytes += 2 * image;
  }
  return bytes;
}

std::size_t lockstep_frames_ahead(const Scenario& scenario) {
  if (scenario.pacing != Pacing::kLockstep || scenario.estimators.empty()) return 0;
  const std::uint64_t fit = kFramesAheadBytes / std::max<std::uint64_t>(frame_bytes(scenario), 1);
  return std::min<std::uint64_t>(fit, kMostFramesAhead);
}

}  // namespace overfly::server
