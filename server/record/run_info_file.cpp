#include "server/record/run_info_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "server/files/file_field.hpp"
#include "server/files/file_stamp.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_lock.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Maximum size of a file that is read for a list of runs.
constexpr std::uint64_t kMostListedBytes = std::uint64_t{16} << 20U;

constexpr std::array<RunStatus, 4> kWrittenStatuses = {
    RunStatus::kRunning, RunStatus::kCompleted, RunStatus::kFailed, RunStatus::kCancelled};

RunStatus written_status(const FileField& field) {
  const std::string text = field.text();
  for (const RunStatus status : kWrittenStatuses) {
    if (text == to_string(status)) return status;
  }
  field.fault("be running, completed, failed or cancelled");
}

/// Reads the valid fields, and keeps the first error of the invalid ones.
class InfoReader {
 public:
  InfoReader(RunInfo& info, std::string file) : info_(info), file_(std::move(file)) {}

  /// @param read  reads one value of the document; if it throws, the info keeps its default
  /// @return whether it could be read
  template <typename Read>
  bool field(const Read& read) {
    try {
      read();
      return true;
    } catch (const FieldFault& fault) {
      tell(fault.what());
      return false;
    }
  }
  void tell(const std::string& fault) {
    if (info_.problem.empty()) info_.problem = file_ + ": " + fault;
  }

 private:
  RunInfo& info_;
  std::string file_;
};

/// Number of frames in a file of rows, from the number in its last complete row: the cost does not
/// depend on the file's length.
std::int64_t frames_written(const fs::path& file) {
  constexpr std::streamoff kLongestRow = 64 << 10;
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return 0;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  if (!in || size <= 0) return 0;
  std::string tail(static_cast<std::size_t>(std::min(size, 2 * kLongestRow)), '\0');
  in.seekg(-static_cast<std::streamoff>(tail.size()), std::ios::end);
  if (!in.read(tail.data(), static_cast<std::streamsize>(tail.size()))) return 0;
  const std::size_t end = tail.rfind('\n');
  if (end == std::string::npos) return 0;
  const std::size_t before = end == 0 ? std::string::npos : tail.rfind('\n', end - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  const Result<Json> row = parse_json(tail.substr(begin, end - begin), file.string());
  if (!row) return 0;
  const auto frame = guarded_fields([&] { return FileField(*row).at("frame").integer(); });
  return frame ? *frame + 1 : 0;
}

void read_version_and_status(const FileField& manifest, InfoReader& reader, RunInfo& info) {
  const bool readable = reader.field([&] {
    const FileField version = manifest.at("format_version");
    if (version.integer() != kRunFormatVersion) {
      version.fault("be " + std::to_string(kRunFormatVersion));
    }
    info.status = written_status(manifest.at("status"));
  });
  if (!readable) info.status = RunStatus::kUnreadable;
}

void read_manifest(const Json& document, const fs::path& file, RunInfo& info) {
  InfoReader reader(info, file.string());
  const FileField manifest(document);
  if (!document.is_object()) {
    info.status = RunStatus::kUnreadable;
    reader.tell("must be an object");
    return;
  }
  read_version_and_status(manifest, reader, info);
  reader.field([&] { info.scenario = manifest.at("scenario").text(); });
  reader.field([&] { info.title = manifest.at("title").text(); });
  reader.field([&] {
    const FileField error = manifest.at("error");
    if (!error.is_null()) info.error = error.text();
  });
  reader.field([&] { info.duration_ns = manifest.at("duration_ns").integer(); });
  reader.field([&] { info.frames = manifest.at("frames").integer(); });
  reader.field([&] { info.frames_total = manifest.at("frames_total").integer(); });
  reader.field([&] { info.pacing = manifest.at("pacing").text(); });
  reader.field([&] {
    if (const auto limited = manifest.find("texture_limited")) {
      info.texture_limited = limited->boolean();
    }
  });
  reader.field([&] {
    for (const FileField& estimator : manifest.at("estimators").items()) {
      std::string name = estimator.at("name").plain_name();
      const auto camera = estimator.find("camera");
      info.estimator_cameras.push_back(camera ? camera->text() : "");
      info.estimators.push_back(std::move(name));
    }
  });
  reader.field([&] {
    // Absent until the run has its cameras.
    const auto cameras = manifest.find("cameras");
    if (!cameras) return;
    for (const FileField& camera : cameras->items()) {
      info.cameras.push_back(camera.at("name").plain_name());
    }
  });
  reader.field([&] {
    const auto attribution = manifest.at("world").find("attribution");
    if (attribution) info.attribution = attribution->text();
  });
}

/// `2026-11-21T09:12:04.123456Z`, with or without the fraction.
bool is_utc(const std::string& text) {
  constexpr std::string_view kForm = "0000-00-00T00:00:00";
  const bool starts = text.size() > kForm.size() && text.size() <= kForm.size() + 11 &&
                      text.back() == 'Z' &&
                      std::equal(kForm.begin(), kForm.end(), text.begin(), [](char form, char c) {
                        return form == '0' ? c >= '0' && c <= '9' : c == form;
                      });
  if (!starts) return false;
  const std::string rest = text.substr(kForm.size(), text.size() - kForm.size() - 1);
  return rest.empty() || (rest.size() > 1 && rest.front() == '.' &&
                          rest.find_first_not_of("0123456789", 1) == std::string::npos);
}

/// Folders of earlier versions have no such file: their scenario was written at creation.
void read_created(const fs::path& folder, RunInfo& info) {
  const fs::path file = created_file(folder);
  const Result<Json> created = read_json(file, kMostListedBytes);
  if (created) {
    InfoReader(info, file.string()).field([&] {
      const FileField time = FileField(*created).at("created_utc");
      if (!is_utc(time.text())) time.fault("be a time like 2026-11-21T09:12:04.123456Z");
      info.created_utc = time.text();
    });
  } else if (created.error().code != ErrorCode::kNotFound && info.problem.empty()) {
    info.problem = created.error().message;
  }
  if (!info.created_utc.empty()) return;
  const FileStamp scenario = FileStamp::of(scenario_file(folder));
  if (scenario.exists) info.created_utc = utc_text(scenario.modified_ns);
}

}  // namespace

void put_run_info(const RunInfo& info, Json& manifest) {
  manifest["status"] = to_string(info.status);
  manifest["scenario"] = info.scenario;
  manifest["title"] = info.title;
  manifest["error"] = info.error.empty() ? Json(nullptr) : Json(info.error);
  manifest["duration_ns"] = info.duration_ns;
  manifest["frames"] = info.frames;
  manifest["frames_total"] = info.frames_total;
  manifest["pacing"] = info.pacing;
  if (info.texture_limited) manifest["texture_limited"] = true;
}

std::string folder_name(const fs::path& folder) {
  // `folder/.` and `folder/` have an empty file name.
  const fs::path plain = fs::absolute(folder).lexically_normal();
  return (plain.has_filename() ? plain : plain.parent_path()).filename().string();
}

Result<RunInfo> read_run_info(const fs::path& folder) {
  // The lock is checked before the manifest is read: a run that ends in between has written its
  // final status. It is checked again afterwards: a run that begins in between holds its lock by
  // then.
  const bool held = RunLock::held(folder);
  const Result<Json> manifest = read_json(manifest_file(folder), kMostListedBytes);
  if (!manifest && manifest.error().code == ErrorCode::kNotFound) return manifest.error();
  RunInfo info;
  info.id = folder_name(folder);
  if (manifest) {
    read_manifest(*manifest, manifest_file(folder), info);
  } else {
    info.status = RunStatus::kUnreadable;
    info.problem = manifest.error().message;
  }
  read_created(folder, info);
  if (info.status == RunStatus::kRunning) {
    info.frames = frames_written(frames_file(folder));
    if (!held && !RunLock::held(folder)) info.status = RunStatus::kInterrupted;
  }
  return info;
}

}  // namespace overfly::engine
