#include "server/calibration/calibrate_images.hpp"

#include <system_error>
#include <utility>
#include <vector>

#include "core/cancel.hpp"
#include "server/dataset/dataset_reader.hpp"
#include "server/dataset/grey_image.hpp"
#include "server/files/number_text.hpp"
#include "server/files/png_file.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using calibration::Calibrator;
using calibration::CalibratorOptions;
using calibration::ViewVerdict;

Error invalid_request(const std::string& what) { return {ErrorCode::kInvalidArgument, what}; }

/// One calibration at work: takes images by name and counts those that give no view.
class Session {
 public:
  static Result<Session> create(const CalibratorOptions& options,
                                const CalibrationProgress& progress) {
    auto calibrator = Calibrator::create(options);
    if (!calibrator) return calibrator.error();
    Session session(std::move(*calibrator), progress);
    session.record_.options = options;
    return session;
  }

  /// The number of images to come, for the progress.
  void expect(std::size_t images) { total_ = images; }

  /// Errors: kCancelled.
  Status take(const std::string& name, const Result<Image>& image) {
    if (is_cancelled(progress_.cancel)) {
      return Error{ErrorCode::kCancelled, "cancelled after " + std::to_string(done_) + " images"};
    }
    const std::string reason =
        image ? reason_of(calibrator_.add(*image, name)) : image.error().message;
    if (!reason.empty()) record_.left_out.push_back({name, reason});
    ++done_;
    if (progress_.show)
      progress_.show(done_, total_, name + ": " + (reason.empty() ? "taken" : reason));
    return {};
  }

  Result<CalibrationRecord> finish(const std::string& source) && {
    record_.source = source;
    record_.names = calibrator_.names();
    auto solved = calibrator_.solve();
    if (!solved) return solved.error().in(source + ": " + counts());
    record_.result = std::move(*solved);
    return std::move(record_);
  }

 private:
  Session(Calibrator calibrator, const CalibrationProgress& progress)
      : calibrator_(std::move(calibrator)), progress_(progress) {}

  static std::string reason_of(const Result<ViewVerdict>& verdict) {
    if (!verdict) return verdict.error().message;
    return *verdict == ViewVerdict::kTaken ? "" : to_string(*verdict);
  }

  /// "3 of 12 images show the board (a.png: no board; ...)"
  [[nodiscard]] std::string counts() const {
    constexpr std::size_t kMostNamed = 3;
    std::string text = std::to_string(record_.names.size()) + " of " + std::to_string(done_) +
                       " images give a view";
    for (std::size_t i = 0; i < record_.left_out.size() && i < kMostNamed; ++i) {
      text += (i == 0 ? " (" : "; ") + record_.left_out[i].name + ": " + record_.left_out[i].reason;
    }
    if (record_.left_out.empty()) return text;
    return text + (record_.left_out.size() > kMostNamed ? "; ...)" : ")");
  }

  Calibrator calibrator_;
  CalibrationProgress progress_;
  std::size_t total_ = 0;
  std::size_t done_ = 0;
  CalibrationRecord record_;
};

/// Errors: kIo.
Status make_image_folder(const fs::path& folder) {
  std::error_code failure;
  if (!folder.empty()) fs::create_directories(folder, failure);
  if (!failure) return {};
  return Error{ErrorCode::kIo, folder.string() + ": cannot be created: " + failure.message()};
}

}  // namespace

Result<CalibrationRecord> calibrate_images(const fs::path& folder,
                                           const CalibratorOptions& options,
                                           const CalibrationProgress& progress) {
  Result<Session> session = Session::create(options, progress);
  if (!session) return session.error();
  const Result<std::vector<fs::path>> files = images_in(folder);
  if (!files) return files.error();
  if (files->empty() || files->size() > kMostCalibrationImages) {
    return invalid_request(folder.string() + ": contains " + std::to_string(files->size()) +
                           " images (PNG, JPEG, PGM, PPM): must be 1 to " +
                           std::to_string(kMostCalibrationImages));
  }
  session->expect(files->size());
  for (const fs::path& file : *files) {
    const Status status = session->take(file.filename().string(), read_grey_image(file));
    if (!status) return status.error();
  }
  return std::move(*session).finish(folder.string());
}

Result<CalibrationRecord> calibrate_virtual(const VirtualCalibration& request,
                                            const CalibratorOptions& options,
                                            const CalibrationProgress& progress) {
  if (Status status = make_image_folder(request.images); !status) return status.error();
  Result<Session> session = Session::create(options, progress);
  if (!session) return session.error();
  auto camera = VirtualCamera::create(request.camera, options.board);
  if (!camera) return camera.error();
  session->expect(camera->views());
  for (std::size_t i = 0; i < camera->views(); ++i) {
    const Image image = camera->image(i);
    const std::string name = "view" + padded(static_cast<std::int64_t>(i), 4) + ".png";
    if (!request.images.empty()) {
      const Status written = write_png_file(request.images / name, image);
      if (!written) return written.error();
    }
    if (Status status = session->take(name, image); !status) return status.error();
  }
  Result<CalibrationRecord> record = std::move(*session).finish("virtual board");
  if (record) record->truth = request.camera.camera;
  return record;
}

}  // namespace overfly::server
