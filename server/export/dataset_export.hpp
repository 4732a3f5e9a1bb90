// Exports: the frames of a run or scenario made again and written as a data set.
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
#include "server/export/flight_video.hpp"
#include "server/export/truth_writer.hpp"

namespace overfly::engine {

struct ExportOptions {
  std::filesystem::path folder;  ///< made; must not exist or be empty
  DatasetFormat format = DatasetFormat::kPng;
  std::set<TruthKind> truth;  ///< images beside each frame
  /// Names; empty = all of them (EuRoC, PNG), the first (TUM mono, KITTI).
  std::vector<std::string> cameras;
  double from_s = 0.0;             ///< frames stamped in [from_s, to_s]
  std::optional<double> to_s;      ///< to the end where it is not given
  flight::ImuModel imu;            ///< of EuRoC
  std::optional<VideoLook> video;  ///< as video.webm beside the images, of the first camera

  RendererFactory renderer_factory;           ///< as the engine's default where it is empty
  const std::atomic<bool>* cancel = nullptr;  ///< stops after the frame at hand
  std::function<void(const std::string&)> notice;
  /// After each frame: how many of how many.
  std::function<void(std::int64_t, std::int64_t)> progress;
};

struct ExportSummary {
  std::int64_t frames = 0;  ///< written
  std::int64_t images = 0;  ///< fewer or more than frames: lost ones, several cameras
  bool cancelled = false;   ///< what is there is whole up to the last frame written
  std::string attribution;  ///< of the world's imagery: must stand by every published image
  nlohmann::json stages;    ///< wall time by stage, as in a run's timings.json
};

/// Makes the frames again and writes them. A run's frames are checked against its record.
/// Errors: kInvalidArgument naming field, value and limit (an unknown camera, an empty span);
/// kConflict for a folder with something in it, and where what is made is not what was recorded;
/// kUnsupported where the format cannot hold the cameras; kIo; as FrameMaker's. After an error the
/// folder holds what was written up to it, without `overfly.json`.
[[nodiscard]] Result<ExportSummary> export_dataset(const ExportSource& source,
                                                   const ExportOptions& options);

}  // namespace overfly::engine
