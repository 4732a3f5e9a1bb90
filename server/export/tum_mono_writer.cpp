// The layout of the TUM monoVO data set (Engel, Usenko, Cremers 2016, arXiv:1607.02555), as DSO
// reads it: images/, times.txt, camera.txt, pcalib.txt, vignette.png, groundtruth.txt.
#include <algorithm>

#include "core/motion/trajectory_io.hpp"
#include "sensor/photometric_calibration.hpp"
#include "server/calibration/camera_text.hpp"
#include "server/export/dataset_writer.hpp"
#include "server/files/number_text.hpp"
#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

Result<std::string> camera_file_text(const CameraSpec& camera) {
  Result<std::string> text = camera_text(CameraFormat::kDso, camera.model, camera.name);
  if (!text) return text.error().in("camera " + camera.name);
  return text;
}

class TumMonoWriter final : public DatasetWriter {
 public:
  explicit TumMonoWriter(const DatasetPlan& plan)
      : folder_(plan.folder),
        camera_(plan.cameras.front()),
        true_model_(plan.true_models.front()),
        digits_(std::max(5, static_cast<int>(std::to_string(plan.last_frame).size()))) {}

  Status begin() {
    if (Status status = make_folder(folder_ / "images"); !status) return status;
    if (Status status = write_camera(); !status) return status;
    if (!camera_.sensor.enabled) return {};
    if (Status status = sensor::write_pcalib(folder_ / "pcalib.txt", camera_.sensor); !status) {
      return status;
    }
    return write_png_file(folder_ / "vignette.png",
                          sensor::vignette_map(camera_.sensor, true_model_));
  }

  Result<std::vector<std::string>> add(const MadeFrame& frame) override {
    const CameraShot& shot = frame.shots.front();
    truth_.push_back({frame.t_ns, shot.drawn.T_world_camera});
    if (!shot.delivered) return std::vector<std::string>(1);
    const std::string id = padded(frame.frame, digits_);
    // Gain brightens like exposure, and the format has no field for it.
    times_ +=
        id + " " + seconds_text(shot.stamp_ns) + " " +
        number_text(static_cast<double>(shot.setting.exposure_ns) * 1e-6 * shot.setting.gain) +
        "\n";
    const Status status = write_png_file(folder_ / "images" / (id + ".png"), grey_of(shot.image));
    if (!status) return status.error();
    return std::vector<std::string>{id};
  }

  Status finish() override {
    if (Status status = write_whole(folder_ / "times.txt", times_); !status) return status;
    const Result<Trajectory> truth = Trajectory::from_poses(truth_);
    if (!truth) return truth.error();
    return write_tum(folder_ / "groundtruth.txt", *truth);
  }

 private:
  Status write_camera() const {
    const Result<std::string> text = camera_file_text(camera_);
    if (!text) return text.error();
    return write_whole(folder_ / "camera.txt", *text);
  }

  std::filesystem::path folder_;
  CameraSpec camera_;
  CameraModel true_model_;
  int digits_;
  std::string times_;
  std::vector<StampedPose> truth_;
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> create_tum_mono_writer(const DatasetPlan& plan) {
  if (plan.cameras.size() != 1) {
    return Error{ErrorCode::kUnsupported,
                 "tum-mono holds one camera, " + std::to_string(plan.cameras.size()) +
                     " were requested: select one with --camera"};
  }
  // Checked before anything is written: a rejected export leaves the folder unchanged.
  const Result<std::string> text = camera_file_text(plan.cameras.front());
  if (!text) return text.error();
  auto writer = std::make_unique<TumMonoWriter>(plan);
  if (Status status = writer->begin(); !status) return status.error();
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

}  // namespace overfly::server
