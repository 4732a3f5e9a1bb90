#include "server/calibration/session/calibration_store.hpp"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "server/calibration/calibration_file.hpp"
#include "server/files/plain_name.hpp"
#include "server/files/take_name.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kLongestCalibrationName = 60;
constexpr std::uint64_t kMostCalibrationBytes = std::uint64_t{16} << 20U;

bool is_calibration_name(const std::string& name) {
  return is_plain_name(name) && name.size() <= kLongestCalibrationName;
}

std::vector<std::string> stored_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const fs::path& file = entry->path();
    const std::string name = file.stem().string();
    std::error_code ignored;
    const bool regular = fs::is_regular_file(entry->symlink_status(ignored));
    if (regular && file.extension() == ".json" && is_calibration_name(name)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

Error unknown_calibration(const std::string& name) {
  constexpr std::size_t kShown = 100;
  return {ErrorCode::kNotFound,
          "calibration \"" + name.substr(0, kShown) + "\": no such calibration"};
}

}  // namespace

Json CalibrationStore::entry(const std::string& name) const {
  const fs::path file = folder_ / (name + ".json");
  std::error_code ignored;
  Json value = {{"name", name}, {"file", fs::absolute(file, ignored).string()}};
  const Result<CameraModel> camera = read_calibrated_camera(file);
  const Result<Json> content = read(name);
  if (!camera || !content) {
    value["error"] = "is no calibration file";
    return value;
  }
  value["width_px"] = camera->pinhole().width_px;
  value["height_px"] = camera->pinhole().height_px;
  value["model"] = to_string(camera->distortion().model);
  value["fx_px"] = camera->pinhole().fx_px;
  value["rms_px"] = content->value("rms_px", Json());
  const auto views = content->find("views");
  value["views"] = views != content->end() && views->is_array() ? Json(views->size()) : Json();
  value["source"] = content->value("source", Json());
  return value;
}

Json CalibrationStore::list() const {
  Json entries = Json::array();
  if (!keeps()) return entries;
  for (const std::string& name : stored_names(folder_)) entries.push_back(entry(name));
  return entries;
}

Status CalibrationStore::save(const std::string& name, const CalibrationRecord& record) const {
  if (!keeps()) {
    return Error{ErrorCode::kUnsupported,
                 "this server keeps no calibrations: it takes no uploads (overfly serve "
                 "--upload-quota)"};
  }
  if (!is_calibration_name(name)) {
    return Error{ErrorCode::kInvalidArgument,
                 "name = " + name.substr(0, kLongestCalibrationName) +
                     ": must be letters, digits, '_', '-' and '.', at most " +
                     std::to_string(kLongestCalibrationName) + ", not beginning with '.'"};
  }
  const std::lock_guard lock(saving_);
  if (stored_names(folder_).size() >= kMostStoredCalibrations) {
    return Error{ErrorCode::kConflict,
                 std::to_string(kMostStoredCalibrations) +
                     " calibrations are kept, which is the limit: delete some"};
  }
  std::error_code failed;
  fs::create_directories(folder_, failed);
  if (failed) return Error{ErrorCode::kIo, folder_.string() + ": " + failed.message()};
  const fs::path file = folder_ / (name + ".json");
  const fs::path part = folder_ / ("." + name + ".part");
  if (Status written = write_json(part, json_from(record)); !written) return written;
  const Result<bool> named = take_free_name(part, file);
  if (named && *named) return {};
  fs::remove(part, failed);
  if (!named) return named.error();
  return Error{ErrorCode::kConflict,
               "calibration \"" + name + "\" exists already: choose another name, or delete it"};
}

Result<fs::path> CalibrationStore::find(const std::string& name) const {
  std::error_code ignored;
  const fs::path file = folder_ / (name + ".json");
  const bool there = keeps() && is_calibration_name(name) &&
                     fs::is_regular_file(fs::symlink_status(file, ignored));
  if (!there) return unknown_calibration(name);
  return file;
}

Result<Json> CalibrationStore::read(const std::string& name) const {
  const Result<fs::path> file = find(name);
  if (!file) return file.error();
  return read_json(*file, kMostCalibrationBytes);
}

Result<std::string> CalibrationStore::text(const std::string& name, CameraFormat format) const {
  const Result<fs::path> file = find(name);
  if (!file) return file.error();
  const Result<CameraModel> camera = read_calibrated_camera(*file);
  if (!camera) return camera.error();
  return camera_text(format, *camera, name);
}

Status CalibrationStore::remove(const std::string& name) const {
  const Result<fs::path> file = find(name);
  if (!file) return file.error();
  std::error_code failed;
  if (fs::remove(*file, failed)) return {};
  if (!failed) return unknown_calibration(name);
  return Error{ErrorCode::kIo, file->string() + ": cannot be deleted: " + failed.message()};
}

}  // namespace overfly::server
