#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "calibration/model_difference.hpp"
#include "core/text/number_text.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/images/logged_images.hpp"
#include "server/dataset/grey_image.hpp"
#include "server/dataset/open_dataset.hpp"
#include "server/imagery/grey_picture.hpp"
#include "server/imagery/image_source.hpp"
#include "server/imagery/video_images.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using flight::logs::LoggedImages;

class LogImages final : public ImageSource {
 public:
  explicit LogImages(std::unique_ptr<LoggedImages> images) : images_(std::move(images)) {}

  [[nodiscard]] const std::vector<std::int64_t>& stamps_ns() const override {
    return images_->stamps_ns();
  }
  [[nodiscard]] Result<Image> read(std::size_t i) override {
    const auto picture = images_->read(i);
    if (!picture) return picture.error();
    Result<Image> grey = grey_picture(*picture);
    if (!grey) return grey.error().in("image " + std::to_string(i) + " of " + images_->topic());
    return grey;
  }
  [[nodiscard]] std::vector<std::string> warnings() const override { return images_->warnings(); }

 private:
  std::unique_ptr<LoggedImages> images_;
};

class FolderImages final : public ImageSource {
 public:
  FolderImages(Dataset dataset, SourcePolicy sources)
      : dataset_(std::move(dataset)), sources_(std::move(sources)) {
    for (const DatasetImage& image : dataset_.images) stamps_ns_.push_back(image.t_ns);
  }

  [[nodiscard]] const std::vector<std::int64_t>& stamps_ns() const override { return stamps_ns_; }
  [[nodiscard]] Result<Image> read(std::size_t i) override {
    const DatasetImage& entry = dataset_.images.at(i);
    // A list may name files outside of the folder. The path that is checked is the one that is
    // read: after a link, ".." leads elsewhere.
    const fs::path file = entry.file.lexically_normal();
    Status allowed = sources_.check(file, "images of the camera");
    if (!allowed) return allowed.error();
    Result<Image> image = read_grey_image(file, dataset_.sample_bits);
    if (!image) return image.error().in(entry.listed_at);
    return image;
  }
  [[nodiscard]] std::vector<std::string> warnings() const override { return dataset_.warnings; }

 private:
  Dataset dataset_;
  SourcePolicy sources_;
  std::vector<std::int64_t> stamps_ns_;
};

/// On a server no link in the folder may lead out of the data folders.
Status check_links(const fs::path& folder, const SourcePolicy& sources) {
  if (!sources.confined()) return {};
  if (Status status = sources.check_place(folder, "images.source"); !status) return status;
  std::error_code failed;
  for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    if (!entry->is_symlink(failed)) continue;
    Status status = sources.check_place(entry->path(), "images.source (a file in this folder)");
    if (!status) return status;
  }
  return {};
}

std::string intrinsics_text(const CameraModel& camera) {
  const PinholeCamera& k = camera.pinhole();
  const Distortion& lens = camera.distortion();
  std::string text = "fx " + number_text(k.fx_px) + ", fy " + number_text(k.fy_px) + ", cx " +
                     number_text(k.cx_px) + ", cy " + number_text(k.cy_px) + " px, distortion " +
                     to_string(lens.model);
  for (int i = 0; i < coefficient_count(lens.model); ++i) text += ' ' + number_text(lens.k[i]);
  return text;
}

/// Compares the camera with the calibration of its data set, which it replaces.
/// @param own  of the size 0 x 0 px if the data set does not state it
std::optional<std::string> calibration_doubt(const CameraModel& camera, const CameraModel& own) {
  PinholeCamera pinhole = own.pinhole();
  const PinholeCamera& size = camera.pinhole();
  if (pinhole.width_px == 0 && pinhole.height_px == 0) {
    pinhole.width_px = size.width_px;
    pinhole.height_px = size.height_px;
  }
  // Of another size: the images are scaled, or the first one of them is an error.
  if (pinhole.width_px != size.width_px || pinhole.height_px != size.height_px) return std::nullopt;
  constexpr double kTolerancePx = 1.0;
  const calibration::ModelDifference apart =
      calibration::model_difference(camera, CameraModel(pinhole, own.distortion()));
  if (apart.max_px <= kTolerancePx) return std::nullopt;
  char distance[80];
  std::snprintf(distance,
                sizeof distance,
                "by %.1f px in the mean, %.1f px at most",
                apart.mean_px,
                apart.max_px);
  return "the camera (" + intrinsics_text(camera) +
         ") contradicts the data set's own calibration (" + intrinsics_text(own) +
         "): projections of the same ray differ " + distance + "; the camera's values are used";
}

Result<std::unique_ptr<ImageSource>> open_folder(const CameraSpec& camera,
                                                 const SourcePolicy& sources) {
  if (Status status = check_links(camera.images->source, sources); !status) return status.error();
  if (const auto& times = camera.images->times) {
    if (Status status = sources.check(*times, "images.times"); !status) return status.error();
  }
  DatasetOptions options;
  options.folder = camera.images->source;
  options.times = camera.images->times;
  options.camera_name = camera.images->topic;
  options.camera = camera.model;
  options.list_only = true;
  Result<Dataset> dataset = open_dataset(options);
  if (!dataset) return dataset.error();
  if (dataset->own_camera) {
    const auto doubt = calibration_doubt(camera.model, *dataset->own_camera);
    if (doubt) dataset->warnings.push_back(camera.images->source.string() + ": " + *doubt);
  }
  return std::unique_ptr<ImageSource>(std::make_unique<FolderImages>(std::move(*dataset), sources));
}

}  // namespace

Result<std::unique_ptr<ImageSource>> open_image_source(const CameraSpec& camera,
                                                       const SourcePolicy& sources,
                                                       const std::atomic<bool>* cancel) {
  const RecordedImages& images = *camera.images;
  std::error_code ignored;
  if (fs::is_directory(images.source, ignored)) return open_folder(camera, sources);
  if (images.times) {
    return Error{ErrorCode::kInvalidArgument,
                 "images.times applies to folders, and " + images.source.string() + " is a file"};
  }
  if (Status status = sources.check(images.source, "images.source"); !status) {
    return status.error();
  }
  if (!flight::logs::detect_format(images.source)) {
    return open_video_images(images.source, cancel);
  }
  auto logged = LoggedImages::open(images.source, images.topic, cancel);
  if (!logged) return logged.error();
  return std::unique_ptr<ImageSource>(std::make_unique<LogImages>(std::move(*logged)));
}

}  // namespace overfly::server
