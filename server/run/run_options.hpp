// What a run is given, and what it gives.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "server/camera/renderer_factory.hpp"
#include "server/frame_cache/frame_folder.hpp"
#include "server/scenario/scenario.hpp"
#include "server/scoring/run_metrics.hpp"
#include "server/timeline/run_timeline.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::server {

class PictureRate;
class RunClock;
class WorldCache;
struct OpenedWorld;

/// Creates an estimator in place of the one named by its type.
using EstimatorFactory = std::function<Result<std::unique_ptr<VoPort>>(const EstimatorSpec&)>;

struct RunOptions {
  std::filesystem::path folder;        ///< created; must not contain a run
  RendererFactory renderer_factory;    ///< EGL if empty
  EstimatorFactory estimator_factory;  ///< chosen by type if empty
  /// Set by another thread to stop the run. The folder is then complete up to the last frame and
  /// marked as cancelled.
  const std::atomic<bool>* cancel = nullptr;
  /// Read by live viewers; created by the run if null.
  std::shared_ptr<RunTimeline> timeline;
  /// Keep live images (camera, debug) in the timeline.
  bool publish_images = false;
  /// Cache of opened worlds to share; if null the run opens its own.
  WorldCache* worlds = nullptr;
  /// Pictures of earlier flights, and for later ones. Flights in lockstep use it.
  std::optional<FrameFolderOptions> frame_cache;
  /// Is notified of the time that a real-time flight has to spare; may be null.
  PictureRate* picture_rate = nullptr;
  /// Paces a real-time run; the machine's clock if null.
  RunClock* clock = nullptr;
  /// Called with one line for each slow step before the first frame; on the run's thread.
  std::function<void(const std::string&)> notice;
  /// Called with what goes wrong without ending the flight or changing it; on the run's thread.
  std::function<void(const std::string&)> warn;
  /// Called with the opened world of the flight; on the run's thread.
  std::function<void(std::shared_ptr<const OpenedWorld>)> world_opened;
  /// Called after each frame on the run's thread.
  std::function<void(const RunInfo&)> progress;
};

struct RunResult {
  RunInfo info;
  RunMetrics metrics;
};

}  // namespace overfly::server
