// Plain PNG and CSV: images/CAMERA/NNNNNN.png, CAMERA.csv with all metadata of each image,
// cameras.json.
#include "server/export/dataset_writer.hpp"
#include "server/files/number_text.hpp"
#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/rows/run_rows.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

constexpr const char* kHeader =
    "frame,t_ns,stamp_ns,file,exposure_ns,gain,saturated_fraction,texels_per_pixel_min,"
    "texels_per_pixel_median,void_fraction,faults,p_world_camera_x_m,p_world_camera_y_m,"
    "p_world_camera_z_m,q_world_camera_x,q_world_camera_y,q_world_camera_z,q_world_camera_w\n";

Json exported_camera(const CameraSpec& camera) {
  const PinholeCamera& c = camera.model.pinhole();
  const Distortion& lens = camera.model.distortion();
  const std::vector<double> coefficients(lens.k.begin(),
                                         lens.k.begin() + coefficient_count(lens.model));
  return {{"name", camera.name},
          {"width_px", c.width_px},
          {"height_px", c.height_px},
          {"fx_px", c.fx_px},
          {"fy_px", c.fy_px},
          {"cx_px", c.cx_px},
          {"cy_px", c.cy_px},
          {"distortion", {{"model", to_string(lens.model)}, {"coefficients", coefficients}}},
          {"T_body_camera", json_from(camera.T_body_camera)}};
}

class PngWriter final : public DatasetWriter {
 public:
  explicit PngWriter(const DatasetPlan& plan)
      : folder_(plan.folder), cameras_(plan.cameras), rows_(plan.cameras.size(), kHeader) {}

  Status begin() {
    Json list = Json::array();
    for (const CameraSpec& camera : cameras_) {
      if (Status status = make_folder(folder_ / "images" / camera.name); !status) return status;
      list.push_back(exported_camera(camera));
    }
    return write_json(folder_ / "cameras.json", list);
  }

  Result<std::vector<std::string>> add(const MadeFrame& frame) override {
    std::vector<std::string> names(frame.shots.size());
    for (std::size_t i = 0; i < frame.shots.size(); ++i) {
      const CameraShot& shot = frame.shots[i];
      if (shot.delivered) names[i] = padded(frame.frame, 6);
      const std::string file = "images/" + cameras_[i].name + "/" + names[i] + ".png";
      rows_[i] += row_of(frame, shot, shot.delivered ? file : "");
      if (!shot.delivered) continue;
      const Status status = shot.image16.empty() ? write_png_file(folder_ / file, shot.image)
                                                 : write_png_file(folder_ / file, shot.image16);
      if (!status) return status.error();
    }
    return names;
  }

  Status finish() override {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      Status status = write_whole(folder_ / (cameras_[i].name + ".csv"), rows_[i]);
      if (!status) return status;
    }
    return {};
  }

 private:
  /// Faults are separated by blanks; a lost image has an empty file name.
  static std::string row_of(const MadeFrame& frame,
                            const CameraShot& shot,
                            const std::string& file) {
    std::string faults;
    for (const std::string& name : shot.faults) faults += (faults.empty() ? "" : " ") + name;
    const Pose& T = shot.drawn.T_world_camera;
    return std::to_string(frame.frame) + "," + std::to_string(frame.t_ns) + "," +
           std::to_string(shot.stamp_ns) + "," + file + "," +
           std::to_string(shot.setting.exposure_ns) + "," +
           number_list({shot.setting.gain,
                        shot.saturated_fraction,
                        shot.drawn.texels_per_pixel_min,
                        shot.drawn.texels_per_pixel_median,
                        shot.drawn.void_fraction},
                       ",") +
           "," + faults + "," +
           number_list({T.translation.x(),
                        T.translation.y(),
                        T.translation.z(),
                        T.rotation.x(),
                        T.rotation.y(),
                        T.rotation.z(),
                        T.rotation.w()},
                       ",") +
           "\n";
  }

  std::filesystem::path folder_;
  std::vector<CameraSpec> cameras_;
  std::vector<std::string> rows_;  ///< one table for each camera
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> create_png_writer(const DatasetPlan& plan) {
  auto writer = std::make_unique<PngWriter>(plan);
  if (Status status = writer->begin(); !status) return status.error();
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

}  // namespace overfly::server
