// Exports a flight as a video file only.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "server/export/export_source.hpp"
#include "server/export/video/flight_video.hpp"

namespace overfly::server {

struct VideoOptions {
  std::filesystem::path file;  ///< .webm; must not exist
  VideoLook look;
  std::string camera;  ///< name; empty = the first
  double from_s = 0.0;
  std::optional<double> to_s;

  RendererFactory renderer_factory;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string&)> notice;
  std::function<void(std::int64_t, std::int64_t)> progress;  ///< frames written, frames in total
};

struct VideoSummary {
  std::int64_t frames = 0;
  bool cancelled = false;  ///< the video ends with the last frame rendered
  std::string attribution;
};

/// Errors: kConflict if the file exists; as VideoLook, FrameSequence and FlightVideo. The file
/// appears whole or not at all.
[[nodiscard]] Result<VideoSummary> export_video(const ExportSource& source,
                                                const VideoOptions& options);

}  // namespace overfly::server
