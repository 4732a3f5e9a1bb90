// Reads the output of `overfly export --format png`: cameras.json, CAMERA.csv,
// images/CAMERA/NNNNNN.png.
#include <algorithm>
#include <map>

#include "server/dataset/dataset_reader.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/rows/run_rows.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The entry of the named camera, or the first one if the name is empty.
Result<Json> camera_entry(const fs::path& path, const std::string& name) {
  const Result<Json> cameras = read_json(path);
  if (!cameras) return cameras.error();
  if (!cameras->is_array() || cameras->empty()) {
    return Error{ErrorCode::kUnreadable, path.string() + ": must be a list of cameras"};
  }
  std::string known;
  for (const Json& camera : *cameras) {
    const Json& its_name = camera.is_object() ? camera.value("name", Json()) : Json();
    if (!its_name.is_string()) {
      return Error{ErrorCode::kUnreadable, path.string() + ": a camera without a name"};
    }
    if (name.empty() || its_name == name) return camera;
    known += (known.empty() ? "" : ", ") + its_name.get<std::string>();
  }
  return Error{ErrorCode::kInvalidArgument,
               "camera \"" + name + "\": not in " + path.string() + " (there are " + known + ")"};
}

/// Numbers, from 1, of the required columns, found by name in the first line.
Result<std::map<std::string, std::size_t>> named_columns(const FieldFile& file,
                                                         const fs::path& path) {
  std::map<std::string, std::size_t> columns;
  if (file.lines().empty()) return Error{ErrorCode::kUnreadable, path.string() + ": is empty"};
  const FieldLine& header = file.lines().front();
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    columns[std::string(header.fields[i])] = i + 1;
  }
  for (const char* name : {"frame", "stamp_ns", "file", "exposure_ns"}) {
    if (!columns.contains(name)) {
      return file.bad_line(header, std::string("no column \"") + name + "\"");
    }
  }
  return columns;
}

Status list_rows(const FieldFile& file,
                 const fs::path& path,
                 const fs::path& folder,
                 std::map<std::string, std::size_t>& columns,
                 std::vector<DatasetImage>& images) {
  const std::size_t count = file.lines().front().fields.size();
  for (auto line = file.lines().begin() + 1; line != file.lines().end(); ++line) {
    if (Status status = file.expect_fields(*line, count); !status) return status;
    const std::string name(line->fields[columns["file"] - 1]);
    if (name.empty()) continue;  // lost before it reached the estimators
    DatasetImage image;
    image.file = folder / name;
    for (const auto& [column, value] : {std::pair("frame", &image.index),
                                        std::pair("stamp_ns", &image.t_ns),
                                        std::pair("exposure_ns", &image.exposure_ns)}) {
      const Result<std::int64_t> number = file.time_ns(*line, columns[column]);
      if (!number) return number.error();
      *value = *number;
    }
    Status status = append_image(path, *line, std::move(image), images);
    if (!status) return status;
  }
  return {};
}

}  // namespace

Result<ListedDataset> read_png_export(const DatasetOptions& options) {
  const fs::path cameras_file = options.folder / "cameras.json";
  const Result<Json> entry = camera_entry(cameras_file, options.camera_name);
  if (!entry) return entry.error();
  const Result<CameraModel> camera = camera_model_from(*entry);
  if (!camera) return camera.error().in(cameras_file.string());
  ListedDataset listed;
  listed.camera = *camera;
  listed.dataset.layout = DatasetLayout::kPng;
  listed.dataset.camera_name = entry->at("name").get<std::string>();
  if (entry->contains("T_body_camera")) {
    const Result<Pose> mount = pose_from(entry->at("T_body_camera"));
    if (!mount) return mount.error().in(cameras_file.string());
    listed.dataset.T_body_camera = *mount;
  }
  if (Status status = check_camera_name(listed.dataset.camera_name); !status) {
    return status.error().in(cameras_file.string());
  }
  const fs::path path = options.folder / (listed.dataset.camera_name + ".csv");
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  auto columns = named_columns(*file, path);
  if (!columns) return columns.error();
  Status status = list_rows(*file, path, options.folder, *columns, listed.dataset.images);
  if (!status) return status.error();
  return listed;
}

}  // namespace overfly::server
