// The ASL layout of the EuRoC data set (Burri et al. 2016, IJRR 35(10)).
#include <system_error>

#include "server/dataset/dataset_reader.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

bool holds_camera(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "cam0" / "data.csv", ignored);
}

}  // namespace

std::optional<fs::path> euroc_cameras_folder(const fs::path& folder) {
  for (const fs::path& candidate : {folder / "mav0", folder}) {
    if (holds_camera(candidate)) return candidate;
  }
  return std::nullopt;
}

Result<ListedDataset> read_euroc(const DatasetOptions& options) {
  const std::optional<fs::path> root = euroc_cameras_folder(options.folder);
  if (!root) {
    return Error{ErrorCode::kNotFound,
                 (options.folder / "mav0" / "cam0" / "data.csv").string() + ": no such file"};
  }
  const std::string name = options.camera_name.empty() ? "cam0" : options.camera_name;
  if (Status status = check_camera_name(name); !status) return status.error();
  const fs::path camera_folder = *root / name;
  const fs::path path = camera_folder / "data.csv";
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  ListedDataset listed;
  listed.dataset.layout = DatasetLayout::kEuroc;
  listed.dataset.camera_name = name;
  std::vector<DatasetImage>& images = listed.dataset.images;
  for (const FieldLine& line : file->lines()) {
    if (Status status = file->expect_fields(line, 2); !status) return status.error();
    const Result<std::int64_t> t_ns = file->time_ns(line, 1);
    if (!t_ns) return t_ns.error();
    DatasetImage image;
    image.file = camera_folder / "data" / fs::path(line.fields[1]);
    image.index = static_cast<std::int64_t>(images.size());
    image.t_ns = *t_ns;
    Status status = append_image(path, line, std::move(image), images);
    if (!status) return status.error();
  }
  const fs::path sensor_file = camera_folder / "sensor.yaml";
  std::error_code ignored;
  if (options.camera && !fs::exists(sensor_file, ignored)) return listed;
  const Result<EurocSensor> sensor = read_euroc_sensor(sensor_file);
  if (!sensor) return sensor.error();
  listed.camera = sensor->camera;
  listed.dataset.T_body_camera = sensor->T_body_camera;
  return listed;
}

}  // namespace overfly::server
