// A sequence of the KITTI odometry benchmark (Geiger, Lenz, Urtasun 2012).
#include <system_error>

#include "server/dataset/dataset_reader.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

struct KittiCamera {
  CameraModel model;
  Pose T_first_camera;
};

/// Parses the line "P0: ..." for image_0, and so on. K [I | t] projects points in the frame of
/// image_0's camera, since KITTI's cameras are rectified.
Result<KittiCamera> camera_of(const fs::path& path, char number) {
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  const std::string name = std::string("P") + number + ":";
  for (const FieldLine& line : file->lines()) {
    if (line.fields.front() != name) continue;
    if (Status status = file->expect_fields(line, 13); !status) return status.error();
    double P[12] = {};
    for (std::size_t i = 0; i < 12; ++i) {
      const Result<double> value = file->number(line, i + 2);
      if (!value) return value.error();
      P[i] = *value;
    }
    if (P[1] != 0.0 || P[4] != 0.0 || P[8] != 0.0 || P[9] != 0.0 || P[10] != 1.0) {
      return file->bad_line(line, "must be [fx 0 cx a; 0 fy cy b; 0 0 1 c]");
    }
    if (P[0] <= 0.0 || P[5] <= 0.0) return file->bad_line(line, "fx and fy must be above 0");
    const Eigen::Vector3d t_camera_first(
        (P[3] - P[2] * P[11]) / P[0], (P[7] - P[6] * P[11]) / P[5], P[11]);
    return KittiCamera{CameraModel(PinholeCamera{0, 0, P[0], P[5], P[2], P[6]}),
                       {Eigen::Quaterniond::Identity(), -t_camera_first}};
  }
  return Error{ErrorCode::kUnreadable, path.string() + ": contains no line " + name};
}

}  // namespace

std::optional<std::string> kitti_image_folder(const fs::path& folder) {
  std::error_code ignored;
  for (const char* name : {"image_0", "image_2", "image_1", "image_3"}) {
    if (fs::is_directory(folder / name, ignored)) return name;
  }
  return std::nullopt;
}

Result<ListedDataset> read_kitti(const DatasetOptions& options) {
  const std::string name = options.camera_name.empty()
                               ? kitti_image_folder(options.folder).value_or("image_0")
                               : options.camera_name;
  if (Status status = check_camera_name(name); !status) return status.error();
  const fs::path path = options.folder / "times.txt";
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  const fs::path pictures = options.folder / name;
  const Result<std::vector<fs::path>> files = images_in(pictures);
  if (!files) return files.error();
  Status status = expect_as_many(path, file->lines().size(), pictures, files->size());
  if (!status) return status.error();
  ListedDataset listed;
  listed.dataset.layout = DatasetLayout::kKitti;
  listed.dataset.camera_name = name;
  std::vector<DatasetImage>& images = listed.dataset.images;
  for (const FieldLine& line : file->lines()) {
    if (status = file->expect_fields(line, 1); !status) return status.error();
    const Result<std::int64_t> t_ns = file->time_s(line, 1);
    if (!t_ns) return t_ns.error();
    DatasetImage image;
    image.file = (*files)[images.size()];
    image.index = static_cast<std::int64_t>(images.size());
    image.t_ns = *t_ns;
    status = append_image(path, line, std::move(image), images);
    if (!status) return status.error();
  }
  const fs::path calibration = options.folder / "calib.txt";
  const Result<KittiCamera> camera = camera_of(calibration, name.back());
  if (!camera && options.camera) return listed;
  if (!camera) return camera.error();
  listed.camera = camera->model;
  listed.dataset.T_first_camera = camera->T_first_camera;
  return listed;
}

}  // namespace overfly::server
