// A video of a flight: what the camera sees, the aircraft from behind, or both side by side.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "server/engine/export/export_source.hpp"

namespace overfly::engine {

enum class VideoView { kCamera, kChase, kBoth };

/// "camera", "chase", "both".
[[nodiscard]] const char* to_string(VideoView view);
[[nodiscard]] std::optional<VideoView> video_view_from(const std::string& text);

struct VideoOptions {
  std::filesystem::path file;  ///< .webm; must not exist
  VideoView view = VideoView::kBoth;
  int quality = 70;         ///< [1, 100], see VideoSettings
  int max_height_px = 720;  ///< taller images are made smaller by a whole factor; >= 16
  std::string camera;       ///< name; empty = the first
  double from_s = 0.0;
  std::optional<double> to_s;

  RendererFactory renderer_factory;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string&)> notice;
  std::function<void(std::int64_t, std::int64_t)> progress;  ///< frames written, of how many
};

struct VideoSummary {
  std::int64_t frames = 0;
  bool cancelled = false;  ///< the video ends with the last frame made
  std::string attribution;
};

/// Stamps in the file are the flight's, to the millisecond, from the first frame shown on. An image
/// that was lost on its way is shown all the same: the video is for people.
/// Errors: kConflict for a file that exists; as FrameSequence's and Vp9Encoder's; kIo. The file
/// appears whole or not at all.
[[nodiscard]] Result<VideoSummary> export_video(const ExportSource& source,
                                                const VideoOptions& options);

}  // namespace overfly::engine
