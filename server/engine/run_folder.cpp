#include "server/engine/run_folder.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <optional>

#include "core/file_text.hpp"
#include "server/engine/whole_file.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string numbered(std::int64_t frame, const char* suffix) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06lld", static_cast<long long>(frame));
  return name.data() + std::string(suffix);
}

std::string numbered_jpg(std::int64_t frame) { return numbered(frame, ".jpg"); }

std::optional<RunStatus> run_status_from(const std::string& text) {
  for (RunStatus status : {RunStatus::kQueued,
                           RunStatus::kRunning,
                           RunStatus::kCompleted,
                           RunStatus::kFailed,
                           RunStatus::kCancelled,
                           RunStatus::kInterrupted}) {
    if (text == to_string(status)) return status;
  }
  return std::nullopt;
}

/// Complete lines of a file; none where it cannot be read.
std::int64_t line_count(const fs::path& file) {
  std::int64_t lines = 0;
  const Status read = read_file_pieces(file, kMaxRowsBytes, nullptr, [&](std::string_view piece) {
    lines += std::count(piece.begin(), piece.end(), '\n');
  });
  return read ? lines : 0;
}

RunInfo info_or_throw(const Json& manifest) {
  RunInfo info;
  const auto status = run_status_from(manifest.at("status").get<std::string>());
  info.status = status.value_or(RunStatus::kFailed);
  info.scenario = manifest.at("scenario").get<std::string>();
  info.title = manifest.at("title").get<std::string>();
  info.error = manifest.at("error").is_string() ? manifest.at("error").get<std::string>() : "";
  info.duration_ns = manifest.at("duration_ns").get<std::int64_t>();
  info.frames = manifest.at("frames").get<std::int64_t>();
  info.frames_total = manifest.at("frames_total").get<std::int64_t>();
  info.pacing = manifest.at("pacing").get<std::string>();
  info.texture_limited = manifest.value("texture_limited", false);
  for (const Json& estimator : manifest.at("estimators")) {
    info.estimators.push_back(estimator.at("name").get<std::string>());
    info.estimator_cameras.push_back(estimator.value("camera", ""));
  }
  for (const Json& camera : manifest.value("cameras", Json::array())) {
    info.cameras.push_back(camera.at("name").get<std::string>());
  }
  info.attribution = manifest.at("world").value("attribution", "");
  return info;
}

}  // namespace

fs::path manifest_file(const fs::path& folder) { return folder / "manifest.json"; }
fs::path scenario_file(const fs::path& folder) { return folder / "scenario.json"; }
fs::path timings_file(const fs::path& folder) { return folder / "timings.json"; }
fs::path metrics_file(const fs::path& folder) { return folder / "metrics.json"; }
fs::path frames_file(const fs::path& folder) { return folder / "frames.jsonl"; }
fs::path log_file(const fs::path& folder) { return folder / "log.jsonl"; }
fs::path truth_file(const fs::path& folder) { return folder / "truth.tum"; }

fs::path estimate_file(const fs::path& folder, const std::string& estimator) {
  return folder / "estimates" / (estimator + ".jsonl");
}

fs::path estimate_tum_file(const fs::path& folder, const std::string& estimator) {
  return folder / "estimates" / (estimator + ".tum");
}

fs::path estimator_output_folder(const fs::path& folder, const std::string& estimator) {
  return folder / "estimators" / estimator;
}

fs::path camera_frames_file(const fs::path& folder, const std::string& camera) {
  return folder / "cameras" / (camera + ".jsonl");
}

fs::path camera_truth_file(const fs::path& folder, const std::string& camera) {
  return folder / "cameras" / (camera + ".tum");
}

fs::path frame_image_file(const fs::path& folder, const std::string& camera, std::int64_t frame) {
  return folder / "frames" / camera / numbered_jpg(frame);
}

fs::path deep_frame_file(const fs::path& folder, const std::string& camera, std::int64_t frame) {
  return folder / "frames16" / camera / numbered(frame, ".png");
}

fs::path frame_image_file(const fs::path& folder, std::int64_t frame) {
  return folder / "frames" / numbered_jpg(frame);
}

fs::path debug_image_file(const fs::path& folder,
                          const std::string& estimator,
                          std::int64_t frame) {
  return folder / "debug" / estimator / numbered_jpg(frame);
}

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

Result<RunInfo> read_run_info(const fs::path& folder) {
  // The lock before the manifest: a run that ends in between has its final status written. And
  // once more after it: a run that begins in between has its lock by then.
  const bool held = RunLock::held(folder);
  const Result<Json> manifest = read_json(manifest_file(folder));
  if (!manifest) return manifest.error();
  RunInfo info;
  try {
    const int version = manifest->at("format_version").get<int>();
    if (version != kRunFormatVersion) {
      return Error{ErrorCode::kUnreadable,
                   manifest_file(folder).string() + ": format_version = " +
                       std::to_string(version) + ": must be " + std::to_string(kRunFormatVersion)};
    }
    info = info_or_throw(*manifest);
  } catch (const Json::exception& error) {
    return Error{ErrorCode::kUnreadable, manifest_file(folder).string() + ": " + error.what()};
  }
  // `folder/.` and `folder/` have no file name of their own.
  const fs::path plain = fs::absolute(folder).lexically_normal();
  info.id = (plain.has_filename() ? plain : plain.parent_path()).filename().string();
  if (const Result<Json> timings = read_json(timings_file(folder)); timings) {
    if (timings->is_object()) info.created_utc = timings->value("created_utc", "");
  }
  if (info.status == RunStatus::kRunning) {
    info.frames = line_count(frames_file(folder));
    if (!held && !RunLock::held(folder)) info.status = RunStatus::kInterrupted;
  }
  return info;
}

std::string utc_text(std::int64_t unix_ns) {
  const std::time_t seconds = unix_ns / 1'000'000'000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

std::int64_t utc_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace overfly::engine
