// Where the images of a calibration session come from.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::server {

struct BoardImage {
  std::string name;
  Result<Image> image;  ///< 8-bit grey, or why it cannot be read
};

/// Used by one thread.
class BoardImages {
 public:
  virtual ~BoardImages() = default;

  /// The next image. @return empty if none comes in time, or at the end
  /// Errors: those that end the source.
  [[nodiscard]] virtual Result<std::optional<BoardImage>> next(
      std::chrono::milliseconds patience) = 0;
  /// There will be no more images.
  [[nodiscard]] virtual bool ended() const = 0;
  /// Number of images; empty if it is not known in advance.
  [[nodiscard]] virtual std::optional<std::size_t> total() const { return std::nullopt; }
  /// The images follow each other quickly: only those that add something are taken, of a board that
  /// is held still.
  [[nodiscard]] virtual bool moving() const { return false; }
  /// The camera that made them, if it is a virtual one.
  [[nodiscard]] virtual std::optional<CameraModel> truth() const { return std::nullopt; }
};

}  // namespace overfly::server
