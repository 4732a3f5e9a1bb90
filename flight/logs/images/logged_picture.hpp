// One image of a log as its message holds it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "flight/logs/ros/ros_cursor.hpp"

namespace overfly::flight::logs {

struct LoggedPicture {
  /// As sensor_msgs/Image names it ("mono8", "bgr8", "bayer_rggb8", ...), or "compressed": a JPEG
  /// or PNG file.
  std::string encoding;
  int width_px = 0;  ///< 0 if compressed
  int height_px = 0;
  std::size_t row_bytes = 0;           ///< from one row to the next
  bool big_endian = false;             ///< of samples of 16 bit
  std::span<const std::uint8_t> data;  ///< at least height_px rows
};

/// The kinds of messages that hold an image.
enum class PictureMessage {
  kRosImage,            ///< sensor_msgs/Image
  kRosCompressedImage,  ///< sensor_msgs/CompressedImage
  kLcm,                 ///< Overfly's image_t or libbot's bot_core.image_t
};

/// Reads the fields of a message.
/// @return empty if it ends early, or its numbers contradict each other
[[nodiscard]] std::optional<LoggedPicture> picture_in(PictureMessage kind,
                                                      std::span<const std::uint8_t> message,
                                                      RosEncoding encoding);

/// The stamp of the image [ns], from the first bytes of a message; empty if there are too few,
/// or if it is not in [0, 2^62].
[[nodiscard]] std::optional<std::int64_t> picture_stamp_ns(PictureMessage kind,
                                                           std::span<const std::uint8_t> message,
                                                           RosEncoding encoding);

/// Whether an LCM message is an image.
[[nodiscard]] bool is_lcm_image(std::span<const std::uint8_t> message);

}  // namespace overfly::flight::logs
