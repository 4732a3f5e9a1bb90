#include "server/imagery/flight_images.hpp"

#include <algorithm>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/time.hpp"

namespace overfly::server {
namespace {

std::string pixels_text(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px) + " px";
}

/// What is added to the stamps of a source.
Result<std::int64_t> shift_of(const RecordedImages& images,
                              const FlightStart& start,
                              std::int64_t first_stamp_ns) {
  std::int64_t zero_ns = 0;
  if (images.clock == ImageClock::kFirstImage) zero_ns = first_stamp_ns;
  if (images.clock == ImageClock::kUtc) zero_ns = start.utc_ns.value_or(0);
  if (images.clock == ImageClock::kLog) {
    if (!start.log_ns) {
      return Error{ErrorCode::kInvalidArgument,
                   "images.clock = \"log\": the flight has no clock of a log"};
    }
    zero_ns = *start.log_ns;
  }
  return images.time_offset_ns - zero_ns;
}

}  // namespace

Status check_image_size(const Image& image, const CameraSpec& camera) {
  const PinholeCamera& pinhole = camera.model.pinhole();
  if (image.width_px == pinhole.width_px && image.height_px == pinhole.height_px) return {};
  return Error{ErrorCode::kUnreadable,
               "the image has " + pixels_text(image.width_px, image.height_px) + ": must have " +
                   pixels_text(pinhole.width_px, pinhole.height_px) + " as the camera"};
}

Result<std::unique_ptr<FlightImages>> FlightImages::open(const CameraSpec& camera,
                                                         const FlightStart& start,
                                                         const SourcePolicy& sources,
                                                         const std::atomic<bool>* cancel) {
  const std::string what = "camera \"" + camera.name + "\"";
  auto source = open_image_source(camera, sources, cancel);
  if (!source) return source.error().in(what);
  std::unique_ptr<FlightImages> images(new FlightImages(camera, std::move(*source)));
  if (Status status = images->place(start); !status) return status.error().in(what);
  // Another size or encoding of all images is a wrong scenario, that of a single one a damaged
  // image.
  const Result<Image> first = images->read(0);
  if (first) return images;
  const bool unsupported = first.error().code == ErrorCode::kUnsupported;
  if (unsupported || (images->count() > 1 && !images->read(1))) return first.error().in(what);
  return images;
}

Status FlightImages::place(const FlightStart& start) {
  const std::vector<std::int64_t>& stamps_ns = source_->stamps_ns();
  const Result<std::int64_t> shift_ns = shift_of(*camera_.images, start, stamps_ns.front());
  if (!shift_ns) return shift_ns.error();
  shift_ns_ = *shift_ns;
  const auto begin = std::lower_bound(stamps_ns.begin(), stamps_ns.end(), -shift_ns_);
  const auto end = std::upper_bound(begin, stamps_ns.end(), start.duration_ns - shift_ns_);
  first_ = begin - stamps_ns.begin();
  count_ = end - begin;
  const auto seconds = [&](std::int64_t stamp_ns) {
    return number_text(s_from_ns(stamp_ns + shift_ns_));
  };
  const std::string span = "the images span [" + seconds(stamps_ns.front()) + ", " +
                           seconds(stamps_ns.back()) + "] s of the flight, which spans [0, " +
                           number_text(s_from_ns(start.duration_ns)) + "] s";
  if (count_ == 0) {
    return Error{ErrorCode::kInvalidArgument,
                 camera_.images->source.string() + ": no image lies within the flight: " + span};
  }
  warnings_ = source_->warnings();
  const auto outside = static_cast<std::int64_t>(stamps_ns.size()) - count_;
  if (outside > 0) {
    warnings_.push_back(std::to_string(outside) + " images lie outside of the flight: " + span);
  }
  return {};
}

std::int64_t FlightImages::t_ns(std::int64_t k) const {
  return source_->stamps_ns()[static_cast<std::size_t>(source_index(k))] + shift_ns_;
}

Result<Image> FlightImages::read_source(std::int64_t index) {
  Result<Image> image = source_->read(static_cast<std::size_t>(index));
  if (!image) return image;
  if (Status status = check_image_size(*image, camera_); !status) {
    return status.error().in("image " + std::to_string(index));
  }
  return image;
}

}  // namespace overfly::server
