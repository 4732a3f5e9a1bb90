// A video that grows frame by frame: what the camera sees, the aircraft from behind, or both.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/export/video_panels.hpp"
#include "server/export/vp9_encoder.hpp"
#include "server/export/webm_file.hpp"

namespace overfly::engine {

enum class VideoView { kCamera, kChase, kBoth };

/// "camera", "chase", "both".
[[nodiscard]] const char* to_string(VideoView view);
[[nodiscard]] std::optional<VideoView> video_view_from(const std::string& text);

struct VideoLook {
  VideoView view = VideoView::kBoth;
  int quality = 70;         ///< [1, 100], see VideoSettings
  int max_height_px = 720;  ///< taller images are made smaller by a whole factor; >= 16

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// Stamps in the file are the flight's, to the millisecond, from the first frame shown on. An image
/// that was lost on its way is shown all the same: the video is for people.
class FlightVideo {
 public:
  /// @param file   appears at `finish`, whole
  /// @param maker  draws the chase view; must outlive the video
  FlightVideo(std::filesystem::path file, const VideoLook& look, FrameMaker& maker);

  /// @param frame  its first shot is shown
  /// Errors: as render_scene, Vp9Encoder and WebmFile, naming the frame.
  [[nodiscard]] Status add(const MadeFrame& frame);
  /// @param rate  how long the last image is shown. Without a frame there is no file.
  [[nodiscard]] Status finish(const FrameRate& rate);

 private:
  [[nodiscard]] Result<Image> compose(const MadeFrame& frame);
  Status open(const Image& first, std::int64_t t_ns);

  std::filesystem::path path_;
  VideoLook look_;
  ChasePanel chase_;
  std::optional<Vp9Encoder> encoder_;
  std::optional<WebmFile> file_;
  std::int64_t begin_ns_ = 0;
  std::int64_t last_ms_ = 0;
};

}  // namespace overfly::engine
