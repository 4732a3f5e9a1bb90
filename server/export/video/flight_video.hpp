// A video written frame by frame: the camera's image, the aircraft from behind, or both.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/export/video/video_panels.hpp"
#include "server/export/video/vp9_encoder.hpp"
#include "server/export/video/webm_file.hpp"

namespace overfly::server {

enum class VideoView { kCamera, kChase, kBoth };

/// "camera", "chase", "both".
[[nodiscard]] const char* to_string(VideoView view);
[[nodiscard]] std::optional<VideoView> video_view_from(const std::string& text);

struct VideoLook {
  VideoView view = VideoView::kBoth;
  int quality = 70;         ///< [1, 100], see VideoSettings
  int max_height_px = 720;  ///< taller images are downsampled by an integer factor; >= 16

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// Time stamps in the file are those of the flight, in milliseconds, relative to the first frame
/// shown. Images that were not delivered are shown too, since the video is for human viewers;
/// recorded images that cannot be read are black.
class FlightVideo {
 public:
  /// @param file  appears whole, at `finish`
  /// @param maker  draws the chase view; must outlive the video
  FlightVideo(std::filesystem::path file, const VideoLook& look, FrameMaker& maker);

  /// @param frame  its first shot is shown
  /// Errors: as render_scene, Vp9Encoder and WebmFile, naming the frame.
  [[nodiscard]] Status add(const MadeFrame& frame);
  /// @param rate  gives the duration of the last image
  /// Without a frame no file is written.
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

}  // namespace overfly::server
