// Images of logs as 8-bit grey.
#pragma once

#include <cstdint>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "flight/logs/images/logged_picture.hpp"
#include "server/files/jpeg.hpp"

namespace overfly::server {

/// Converts an image of any encoding of sensor_msgs/Image with 8 or 16 bit: grey, RGB, Bayer
/// patterns, YUV 4:2:2; and JPEG and PNG files.
///
/// Colour becomes luma (ITU-R BT.601) as for colour cameras, of YUV it is Y. Of samples of 16 bit
/// the upper 8 are kept. Bayer patterns are interpolated bilinearly.
/// @param most_pixels  JPEG and PNG files with more are refused before they are decoded
/// Errors: kUnsupported naming the encoding; kUnreadable; kInvalidArgument for too many pixels.
[[nodiscard]] Result<Image> grey_picture(const flight::logs::LoggedPicture& picture,
                                         std::int64_t most_pixels = kMostImagePixels);

}  // namespace overfly::server
