// Exports: renders the frames of a run or scenario again and writes them as a data set.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/export/dataset_writer.hpp"
#include "server/export/export_source.hpp"
#include "server/export/truth_writer.hpp"
#include "server/export/video/flight_video.hpp"

namespace overfly::server {

struct ExportOptions {
  std::filesystem::path folder;  ///< created; must not exist, or be empty
  DatasetFormat format = DatasetFormat::kPng;
  std::set<TruthKind> truth;  ///< truth images for each frame
  /// Names; empty = all cameras (EuRoC, PNG), the first one (TUM mono, KITTI).
  std::vector<std::string> cameras;
  double from_s = 0.0;         ///< frames stamped in [from_s, to_s]
  std::optional<double> to_s;  ///< empty = to the end
  /// For EuRoC. Empty: the scenario's own, or else the defaults. A scenario with an IMU takes no
  /// other.
  std::optional<flight::ImuModel> imu;
  std::optional<VideoLook> video;  ///< writes video.webm next to the images, of the first camera

  RendererFactory renderer_factory;           ///< the server's default if empty
  const std::atomic<bool>* cancel = nullptr;  ///< stops after the current frame
  std::function<void(const std::string&)> notice;
  /// Called after each frame: frames done, frames in total.
  std::function<void(std::int64_t, std::int64_t)> progress;
};

struct ExportSummary {
  std::int64_t frames = 0;  ///< frames written
  /// Differs from frames if images were lost or there are several cameras.
  std::int64_t images = 0;
  bool cancelled = false;   ///< the output is complete up to the last frame written
  std::string attribution;  ///< of the world's imagery: must accompany every published image
  nlohmann::json stages;    ///< wall time by stage, as in a run's timings.json
};

/// Renders the frames again and writes them. Frames of a run are checked against its record.
/// Errors: kInvalidArgument naming field, value and limit (an unknown camera, an empty span);
/// kConflict for a folder that is not empty, and if a rendered frame differs from the recorded one;
/// kUnsupported if the format cannot represent the cameras; kIo; as FrameMaker. After an error the
/// folder holds the data written so far, without `overfly.json`.
[[nodiscard]] Result<ExportSummary> export_dataset(const ExportSource& source,
                                                   const ExportOptions& options);

}  // namespace overfly::server
