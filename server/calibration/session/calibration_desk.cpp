#include "server/calibration/session/calibration_desk.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <random>
#include <string_view>
#include <utility>

#include "core/text/lower_case.hpp"
#include "core/text/natural_order.hpp"
#include "server/calibration/calibrate_images.hpp"
#include "server/dataset/grey_image.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kMostListedFolders = 500;
constexpr std::size_t kMostListedRecordings = 500;

bool ends_with_any(const std::string& name, std::initializer_list<std::string_view> endings) {
  const std::string lower = lower_case(name);
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) {
    return lower.size() > ending.size() && lower.ends_with(ending);
  });
}

/// Recordings that may have images.
bool may_have_images(const std::string& name) {
  return ends_with_any(
      name,
      {".mcap", ".bag", ".active", ".lcm", ".log", ".webm", ".mkv", ".mp4", ".mov", ".avi", ".ts"});
}

bool is_image_file(const std::string& name) { return is_image_name(name); }

std::string folder_of(const std::string& name) { return name.substr(0, name.rfind('/')); }

Error no_source(const std::string& what, const std::string& name) {
  constexpr std::size_t kShown = 200;
  return {ErrorCode::kNotFound, what + " \"" + name.substr(0, kShown) + "\": no such " + what};
}

/// Sixteen hexadecimal digits.
std::string random_id() {
  std::random_device source;
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%08x%08x", source(), source());
  return text.data();
}

}  // namespace

Json CalibrationDesk::sources_json() const {
  const ServedFolders folders = options_.folders();
  std::map<std::string, std::size_t> counts;
  bool complete = visit_data_files(folders, is_image_file, [&](const DataFile& file) {
    ++counts[folder_of(file.name)];
    return counts.size() <= kMostListedFolders;
  });
  Json listed = Json::array();
  for (const auto& [name, count] : counts) listed.push_back({{"name", name}, {"images", count}});
  Json recordings = Json::array();
  complete = visit_data_files(folders,
                              may_have_images,
                              [&](const DataFile& file) {
                                recordings.push_back({{"name", file.name}});
                                return recordings.size() < kMostListedRecordings;
                              }) &&
             complete;
  Json cameras = Json::array();
  for (const LiveAddress& camera : options_.cameras) cameras.push_back({{"name", camera.name}});
  return {{"folders", std::move(listed)},
          {"recordings", std::move(recordings)},
          {"cameras", std::move(cameras)},
          {"keeps", store_.keeps()},
          {"complete", complete}};
}

Result<OpenBoardImages> CalibrationDesk::folder_source(const std::string& name) const {
  std::vector<fs::path> files;
  visit_data_folder(options_.folders(), name, is_image_file, [&](const DataFile& file) {
    files.push_back(file.path);
    return files.size() <= kMostCalibrationImages;
  });
  if (files.empty()) return no_source("folder", name);
  if (files.size() > kMostCalibrationImages) {
    const std::string most = std::to_string(kMostCalibrationImages);
    return Error{ErrorCode::kInvalidArgument,
                 name + ": contains more than " + most +
                     " images (PNG, JPEG, PGM, PPM): must be 1 to " + most};
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return before_naturally(a.filename().string(), b.filename().string());
  });
  return OpenBoardImages([files = std::move(files)](const std::atomic<bool>*) {
    return Result<std::unique_ptr<BoardImages>>(folder_images(files));
  });
}

Result<OpenBoardImages> CalibrationDesk::recording_source(const DeskRequest& request) const {
  ServedFolders folders = options_.folders();
  const auto file = find_data_file(folders, request.name, may_have_images);
  if (!file) return no_source("recording", request.name);
  return OpenBoardImages([file = *file,
                          topic = request.topic,
                          name = request.name,
                          sources = std::move(folders.sources)](const std::atomic<bool>* cancel) {
    auto images = recording_images(file, topic, sources, cancel);
    if (images) return images;
    // Errors name the file by its path, clients by its name.
    std::string message = images.error().message;
    const std::string path = file.string();
    // Goes on behind the name, which may contain the path of a relative folder.
    for (std::size_t at = message.find(path); at != std::string::npos;
         at = message.find(path, at + name.size())) {
      message.replace(at, path.size(), name);
    }
    return Result<std::unique_ptr<BoardImages>>(Error{images.error().code, message});
  });
}

Result<OpenBoardImages> CalibrationDesk::scenario_source(const DeskRequest& request) const {
  auto camera = options_.scenario_camera(request.name, request.camera);
  if (!camera) return camera.error();
  if (camera->images) {
    return Error{ErrorCode::kInvalidArgument,
                 "camera = " + camera->name + ": has recorded images, so it is no virtual camera"};
  }
  return OpenBoardImages([camera = std::move(*camera),
                          board = request.calibrator.board,
                          views = request.views,
                          seed = request.seed](const std::atomic<bool>*) {
    return virtual_images(camera, board, views, seed);
  });
}

Result<OpenBoardImages> CalibrationDesk::camera_source(const std::string& name) const {
  for (const LiveAddress& camera : options_.cameras) {
    if (camera.name != name) continue;
    return OpenBoardImages(
        [camera](const std::atomic<bool>* cancel) { return camera_images(camera, cancel); });
  }
  return Error{ErrorCode::kNotFound,
               "camera \"" + name.substr(0, 200) +
                   "\": is none that this server may open (overfly serve --allow-camera)"};
}

Result<SessionRequest> CalibrationDesk::session_request(const DeskRequest& request) const {
  SessionRequest wanted;
  wanted.calibrator = request.calibrator;
  wanted.begin_thread = options_.begin_thread;
  Result<OpenBoardImages> open = OpenBoardImages();
  switch (request.kind) {
    case SourceKind::kFolder:
      wanted.source = "folder " + request.name;
      open = folder_source(request.name);
      break;
    case SourceKind::kRecording:
      wanted.source =
          "recording " + request.name + (request.topic.empty() ? "" : ", " + request.topic);
      open = recording_source(request);
      break;
    case SourceKind::kScenario:
      wanted.source = "scenario " + request.name + ", virtual board" +
                      (request.camera.empty() ? "" : ", camera " + request.camera);
      open = scenario_source(request);
      break;
    case SourceKind::kCamera:
      wanted.source = "camera " + request.name;
      open = camera_source(request.name);
      break;
    case SourceKind::kUpload:
      wanted.source = "uploaded images";
      break;
  }
  if (!open) return open.error();
  wanted.open = std::move(*open);
  return wanted;
}

/// @pre the lock is held
void CalibrationDesk::bury() {
  std::erase_if(ending_, [](const auto& session) { return session->over(); });
}

/// Ends the session that was left alone for longest if there are too many: the new one does not
/// wait for its end. @pre the lock is held
bool CalibrationDesk::make_room() {
  bury();
  const std::size_t count = entries_.size() + ending_.size();
  if (count < kMostSessions) return true;
  if (count > kMostSessions) return false;
  const auto oldest =
      std::max_element(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.session->untouched_for() < b.session->untouched_for();
      });
  if (oldest == entries_.end() || oldest->session->untouched_for() < options_.patience) {
    return false;
  }
  close(oldest);
  return true;
}

/// @pre the lock is held
void CalibrationDesk::close(std::vector<Entry>::iterator entry) {
  entry->session->cancel();
  ending_.push_back(entry->session);
  entries_.erase(entry);
  bury();
}

Result<std::string> CalibrationDesk::begin(const DeskRequest& request) {
  auto wanted = session_request(request);
  if (!wanted) return wanted.error();
  const std::lock_guard lock(mutex_);
  if (!make_room()) {
    return Error{ErrorCode::kConflict,
                 std::to_string(kMostSessions) +
                     " calibrations are in progress, which is this server's limit: close one"};
  }
  auto session = CalibrationSession::begin(std::move(*wanted));
  if (!session) return session.error();
  entries_.push_back({random_id(), std::move(*session)});
  return entries_.back().id;
}

Result<std::shared_ptr<CalibrationSession>> CalibrationDesk::session(const std::string& id,
                                                                     bool keeps_it) {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) {
    if (entry.id != id) continue;
    if (keeps_it) entry.session->touch();
    return entry.session;
  }
  return Error{ErrorCode::kNotFound, "no such calibration is in progress: it was closed"};
}

std::vector<CalibrationDesk::Entry> CalibrationDesk::sessions() {
  const std::lock_guard lock(mutex_);
  return entries_;
}

Status CalibrationDesk::end(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(
      entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.id == id; });
  if (found == entries_.end()) {
    return Error{ErrorCode::kNotFound, "no such calibration is in progress: it was closed"};
  }
  close(found);
  return {};
}

}  // namespace overfly::server
