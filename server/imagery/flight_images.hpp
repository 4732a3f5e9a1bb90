// The recorded images of a flight, by frame.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "server/imagery/image_source.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server {

/// When the flight's t = 0 is, by the clocks of images.
struct FlightStart {
  std::optional<std::int64_t> utc_ns;
  std::optional<std::int64_t> log_ns;  ///< by the clock of the log that is flown
  std::int64_t duration_ns = 0;
};

/// Frame k is the k-th image within the flight. Used by one thread.
class FlightImages {
 public:
  /// @param camera  of the scenario, with `images`; must outlive the object
  /// Errors: as open_image_source; kInvalidArgument if no image lies within the flight, or if the
  /// flight has no clock of a log; kUnsupported if the first image has an encoding that is not
  /// read; as read() if neither the first nor the second image can be read.
  static Result<std::unique_ptr<FlightImages>> open(const CameraSpec& camera,
                                                    const FlightStart& start,
                                                    const SourcePolicy& sources,
                                                    const std::atomic<bool>* cancel);

  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Time of frame k in the flight.
  [[nodiscard]] std::int64_t t_ns(std::int64_t k) const;
  /// Number of frame k's image in its source.
  [[nodiscard]] std::int64_t source_index(std::int64_t k) const { return first_ + k; }
  /// Errors: as ImageSource::read; kUnreadable for another size than the camera's.
  [[nodiscard]] Result<Image> read(std::int64_t k) { return read_source(source_index(k)); }
  /// What was left out of the source, and how much of it lies outside of the flight.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  FlightImages(const CameraSpec& camera, std::unique_ptr<ImageSource> source)
      : camera_(camera), source_(std::move(source)) {}
  Status place(const FlightStart& start);
  [[nodiscard]] Result<Image> read_source(std::int64_t index);

  const CameraSpec& camera_;
  std::unique_ptr<ImageSource> source_;
  std::int64_t shift_ns_ = 0;  ///< added to the source's stamps
  std::int64_t first_ = 0;     ///< index of frame 0 in the source
  std::int64_t count_ = 0;
  std::vector<std::string> warnings_;
};

/// Checks the size of a recorded image. Errors: kUnreadable.
[[nodiscard]] Status check_image_size(const Image& image, const CameraSpec& camera);

}  // namespace overfly::server
