// The layout of the TUM monoVO data set (Engel, Usenko, Cremers 2016, arXiv:1607.02555), as DSO
// reads it: images/, times.txt, camera.txt, pcalib.txt, vignette.png, groundtruth.txt.
#include <algorithm>
#include <cmath>

#include "core/motion/trajectory_io.hpp"
#include "sensor/photometric_calibration.hpp"
#include "server/export/dataset_writer.hpp"
#include "server/files/number_text.hpp"
#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

/// Name and coefficients of a lens, as in the first line of camera.txt.
/// Errors: kUnsupported for a lens that the file cannot represent.
Result<std::pair<std::string, std::string>> lens_text(const CameraSpec& camera) {
  const Distortion& lens = camera.model.distortion();
  const auto& k = lens.k;
  switch (lens.model) {
    case DistortionModel::kNone:
      return std::pair<std::string, std::string>("Pinhole", "0");
    case DistortionModel::kFov:
      return std::pair<std::string, std::string>("FOV", number_text(k[0]));
    case DistortionModel::kEquidistant:
      return std::pair("EquiDistant" + std::string(), number_list({k[0], k[1], k[2], k[3]}, " "));
    case DistortionModel::kRadtan:
      break;
  }
  if (k[4] != 0.0) {
    return Error{ErrorCode::kUnsupported,
                 "camera " + camera.name + ": distortion k3 = " + number_text(k[4]) +
                     ": must be 0, since camera.txt holds only k1 k2 p1 p2"};
  }
  return std::pair("RadTan" + std::string(), number_list({k[0], k[1], k[2], k[3]}, " "));
}

class TumMonoWriter final : public DatasetWriter {
 public:
  explicit TumMonoWriter(const DatasetPlan& plan)
      : folder_(plan.folder),
        camera_(plan.cameras.front()),
        digits_(std::max(5, static_cast<int>(std::to_string(plan.last_frame).size()))) {}

  Status begin() {
    if (Status status = make_folder(folder_ / "images"); !status) return status;
    if (Status status = write_camera(); !status) return status;
    if (!camera_.sensor.enabled) return {};
    if (Status status = sensor::write_pcalib(folder_ / "pcalib.txt", camera_.sensor); !status) {
      return status;
    }
    return write_png_file(folder_ / "vignette.png",
                          sensor::vignette_map(camera_.sensor, camera_.model));
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
  /// Intrinsics relative to the image's size, which every reader of the format accepts. DSO
  /// converts them to pixels as cx = cx_relative * width - 0.5; half a pixel is therefore added
  /// here.
  Status write_camera() const {
    const auto lens = lens_text(camera_);
    if (!lens) return lens.error();
    const PinholeCamera& c = camera_.model.pinhole();
    const std::string size = std::to_string(c.width_px) + " " + std::to_string(c.height_px) + "\n";
    const std::string intrinsics = number_list({c.fx_px / c.width_px,
                                                c.fy_px / c.height_px,
                                                (c.cx_px + 0.5) / c.width_px,
                                                (c.cy_px + 0.5) / c.height_px},
                                               " ");
    const bool pinhole = camera_.model.distortion().none();
    return write_whole(folder_ / "camera.txt",
                       lens->first + " " + intrinsics + " " + lens->second + "\n" + size +
                           (pinhole ? "none" : "crop") + "\n" + size);
  }

  std::filesystem::path folder_;
  CameraSpec camera_;
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
  const auto lens = lens_text(plan.cameras.front());
  if (!lens) return lens.error();
  auto writer = std::make_unique<TumMonoWriter>(plan);
  if (Status status = writer->begin(); !status) return status.error();
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

}  // namespace overfly::server
