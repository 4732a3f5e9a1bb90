#include "server/record/run_info_file.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "server/files/file_field.hpp"
#include "server/files/file_stamp.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_lock.hpp"
#include "server/record/run_manifest.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

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
    const Result<std::string> time = guarded_fields([&] {
      const FileField field = FileField(*created).at("created_utc");
      if (!is_utc(field.text())) field.reject("be a time like 2026-11-21T09:12:04.123456Z");
      return field.text();
    });
    if (time) info.created_utc = *time;
    if (!time && info.problem.empty()) info.problem = file.string() + ": " + time.error().message;
  } else if (created.error().code != ErrorCode::kNotFound && info.problem.empty()) {
    info.problem = created.error().message;
  }
  if (!info.created_utc.empty()) return;
  const FileStamp scenario = FileStamp::of(scenario_file(folder));
  if (scenario.exists) info.created_utc = utc_text(scenario.modified_ns);
}

}  // namespace

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
  const Result<ReadManifest> manifest = read_run_manifest(folder, kMostListedBytes);
  if (!manifest && manifest.error().code == ErrorCode::kNotFound) return manifest.error();
  RunInfo info = manifest ? run_info_from(manifest->values) : RunInfo();
  info.id = folder_name(folder);
  info.problem = manifest ? manifest->problem() : manifest.error().message;
  if (!manifest || !manifest->check(ManifestPart::kHead)) info.status = RunStatus::kUnreadable;
  read_created(folder, info);
  if (info.status == RunStatus::kRunning) {
    info.frames = frames_written(CameraFiles::of_main_camera(folder).rows());
    if (!held && !RunLock::held(folder)) info.status = RunStatus::kInterrupted;
  }
  return info;
}

}  // namespace overfly::server
