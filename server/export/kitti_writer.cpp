// A sequence of the KITTI odometry benchmark (Geiger, Lenz, Urtasun 2012) with one camera: image_0/
// (grey) or image_2/ (colour), times.txt, calib.txt, poses.txt.
#include "server/export/dataset_writer.hpp"
#include "server/files/number_text.hpp"
#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

class KittiWriter final : public DatasetWriter {
 public:
  explicit KittiWriter(const DatasetPlan& plan)
      : folder_(plan.folder),
        images_(plan.folder / (plan.cameras.front().rgb ? "image_2" : "image_0")),
        camera_(plan.cameras.front().model.pinhole()) {}

  Status begin() {
    if (Status status = make_folder(images_); !status) return status;
    const PinholeCamera& c = camera_;
    const std::string P =
        number_list({c.fx_px, 0, c.cx_px, 0, 0, c.fy_px, c.cy_px, 0, 0, 0, 1, 0}, " ");
    std::string calib;
    for (const char* name : {"P0: ", "P1: ", "P2: ", "P3: "}) calib += name + P + "\n";
    return write_whole(folder_ / "calib.txt", calib);
  }

  Result<std::vector<std::string>> add(const MadeFrame& frame) override {
    const CameraShot& shot = frame.shots.front();
    // The format identifies images by position, so a lost image has no line.
    if (!shot.delivered) return std::vector<std::string>(1);
    const Pose& T_world_camera = shot.drawn.T_world_camera;
    if (written_ == 0) {
      T_first_world_ = T_world_camera.inverse();
      first_ns_ = shot.stamp_ns;
    }
    times_ += seconds_text(shot.stamp_ns - first_ns_) + "\n";
    poses_ += matrix_rows(T_first_world_ * T_world_camera, 3, " ") + "\n";
    const std::string name = padded(written_++, 6);
    const Status status = write_png_file(images_ / (name + ".png"), shot.image);
    if (!status) return status.error();
    return std::vector<std::string>{name};
  }

  Status finish() override {
    if (Status status = write_whole(folder_ / "times.txt", times_); !status) return status;
    return write_whole(folder_ / "poses.txt", poses_);
  }

 private:
  std::filesystem::path folder_;
  std::filesystem::path images_;
  PinholeCamera camera_;
  std::int64_t written_ = 0;
  std::int64_t first_ns_ = 0;
  Pose T_first_world_;
  std::string times_;
  std::string poses_;
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> create_kitti_writer(const DatasetPlan& plan) {
  if (plan.cameras.size() != 1) {
    return Error{ErrorCode::kUnsupported,
                 "kitti holds one camera, " + std::to_string(plan.cameras.size()) +
                     " were requested: select one with --camera"};
  }
  const CameraSpec& camera = plan.cameras.front();
  if (!camera.model.distortion().none()) {
    return Error{ErrorCode::kUnsupported,
                 "camera " + camera.name +
                     ": calib.txt of kitti cannot describe a lens, distortion is " +
                     to_string(camera.model.distortion().model) + ": must be none"};
  }
  auto writer = std::make_unique<KittiWriter>(plan);
  if (Status status = writer->begin(); !status) return status.error();
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

}  // namespace overfly::server
