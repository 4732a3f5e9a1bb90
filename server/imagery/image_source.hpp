// Recorded images with time stamps, wherever they come from.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server {

/// Used by one thread.
class ImageSource {
 public:
  virtual ~ImageSource() = default;

  /// Stamps of the images [ns], increasing; at least one.
  [[nodiscard]] virtual const std::vector<std::int64_t>& stamps_ns() const = 0;
  /// Reads an image as 8-bit grey. Reading them in order is fastest.
  /// Errors: naming file and image: kNotFound, kUnreadable, kUnsupported; kIo.
  [[nodiscard]] virtual Result<Image> read(std::size_t i) = 0;
  /// What was left out of the source.
  [[nodiscard]] virtual std::vector<std::string> warnings() const = 0;
};

/// Opens a folder (a data set, or images with `times`), a log (ROS bag, MCAP, LCM) or a video. The
/// content decides.
/// @param camera  the scenario's; must have `images`
/// @param sources  which files may be read
/// @param cancel  may be null
/// Errors: kNotFound; kInvalidArgument; kUnreadable; kUnsupported for a video in a build without
/// FFmpeg; kIo; kCancelled.
[[nodiscard]] Result<std::unique_ptr<ImageSource>> open_image_source(
    const CameraSpec& camera, const SourcePolicy& sources, const std::atomic<bool>* cancel);

}  // namespace overfly::server
