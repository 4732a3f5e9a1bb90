// What a run is given, and what it gives.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/camera/renderer_factory.hpp"
#include "server/record/run_timeline.hpp"
#include "server/scenario/scenario.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::engine {

class PictureRate;
class RunClock;
class WorldCache;
struct OpenedWorld;

/// Makes an estimator instead of the one that its type names.
using EstimatorFactory = std::function<Result<std::unique_ptr<VoPort>>(const EstimatorSpec&)>;

struct RunOptions {
  std::filesystem::path folder;        ///< made; must not hold a run already
  RendererFactory renderer_factory;    ///< EGL where it is empty
  EstimatorFactory estimator_factory;  ///< by their types where it is empty
  /// Set by another thread to stop: the folder is then complete to the last frame and cancelled.
  const std::atomic<bool>* cancel = nullptr;
  /// Where live readers look; made by the run when null.
  std::shared_ptr<RunTimeline> timeline;
  /// Keep live pictures (camera, debug) in the timeline.
  bool publish_images = false;
  /// Opened worlds to share; the run opens its own when null.
  WorldCache* worlds = nullptr;
  /// Hears how much time a flight in real time has left; may be null.
  PictureRate* picture_rate = nullptr;
  /// Paces a real-time run; the machine's clock when null.
  RunClock* clock = nullptr;
  /// What takes long before the first frame, one line at a time; on the run's thread.
  std::function<void(const std::string&)> notice;
  /// Called with the world that is flown over; on the run's thread.
  std::function<void(std::shared_ptr<const OpenedWorld>)> world_opened;
  /// Called after each frame on the run's thread.
  std::function<void(const RunInfo&)> progress;
};

struct RunResult {
  RunInfo info;
  nlohmann::json metrics;  ///< as in metrics.json
};

}  // namespace overfly::engine
