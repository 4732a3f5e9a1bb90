#include "server/trajectories/trajectory_library.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/cancel.hpp"
#include "core/text/lower_case.hpp"
#include "core/text/shown_path.hpp"
#include "core/time.hpp"
#include "server/files/data_files.hpp"
#include "server/files/file_stamp.hpp"
#include "server/trajectories/run_trajectory.hpp"
#include "server/trajectories/trajectory_tables.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::array<std::string_view, 4> kTrajectoryExtensions = {
    ".tum", ".txt", ".csv", ".kitti"};

constexpr const char* kTimesFile = "times.txt";

bool has_trajectory_extension(const std::string& name) {
  const std::string lower = lower_case(name);
  return std::any_of(
      kTrajectoryExtensions.begin(), kTrajectoryExtensions.end(), [&](std::string_view extension) {
        return lower.size() > extension.size() && lower.ends_with(extension);
      });
}

/// The times file that belongs to a KITTI file, if there is one.
fs::path times_file_of(const fs::path& file) { return file.parent_path() / kTimesFile; }

/// An upload of this name would be read as the times of all KITTI files in the folder of uploads.
bool may_be_uploaded(const std::string& name) {
  return has_trajectory_extension(name) && lower_case(name) != kTimesFile;
}

std::string format_of_trajectory(const fs::path& file) {
  const auto format = detect_trajectory(file);
  return format ? to_string(*format) : "";
}

Json list_entry(const DataFile& file, const std::string& format, std::int64_t size_bytes) {
  return {{"name", "file:" + file.name},
          {"format", format},
          {"folder", fs::path(file.name).parent_path().generic_string()},
          {"size_bytes", size_bytes},
          {"uploaded", file.uploaded}};
}

Json description_json(const std::string& reference, const ServedTrajectory& trajectory) {
  const Trajectory& poses = trajectory.file.trajectory;
  return {{"name", reference},
          {"kind", trajectory.kind},
          {"poses", poses.size()},
          {"has_times", trajectory.file.has_times},
          {"unknown_poses", trajectory.file.unknown_poses},
          {"first_s", s_from_ns(poses.begin_ns())},
          {"last_s", s_from_ns(poses.end_ns())},
          {"path_m", poses.path_length_m()},
          {"warnings", trajectory.file.warnings}};
}

Json outcome_json(const std::optional<RunOutcome>& outcome) {
  if (!outcome) return nullptr;
  return {
      {"outcome", outcome->outcome},
      {"outcome_time_s", outcome->outcome_time_s ? Json(*outcome->outcome_time_s) : Json(nullptr)},
      {"coverage", outcome->coverage}};
}

Json error_json(const Error& error) {
  return {{"code", to_string(error.code)}, {"message", error.message}};
}

}  // namespace

const UploadKind& trajectory_upload_kind() {
  static const UploadKind kind{"trajectory",
                               ".tum, .txt, .csv, .kitti, and not be times.txt",
                               may_be_uploaded,
                               [](const fs::path& file) -> Status {
                                 const auto read =
                                     read_trajectory(file, kServedTrajectoryLimits, nullptr);
                                 if (!read) return read.error();
                                 return {};
                               },
                               kServedTrajectoryLimits.max_bytes};
  return kind;
}

TrajectoryLibrary::TrajectoryLibrary(
    LogLibrary& logs, std::function<Result<fs::path>(const std::string& id)> run_folder)
    : logs_(logs), run_folder_(std::move(run_folder)), formats_(format_of_trajectory) {}

Json TrajectoryLibrary::list() {
  std::vector<Json> entries;
  const auto take = [&](const DataFile& file) {
    if (entries.size() >= kMaxTrajectories) return false;
    const FileStamp stamp = FileStamp::of(file.path);
    const std::string format = formats_.of(file.path, stamp);
    if (!format.empty()) entries.push_back(list_entry(file, format, stamp.size_bytes));
    return true;
  };
  const bool complete = visit_data_files(logs_.folders(), has_trajectory_extension, take);
  std::sort(entries.begin(), entries.end(), [](const Json& a, const Json& b) {
    return std::pair(!a.at("uploaded"), a.at("name")) < std::pair(!b.at("uploaded"), b.at("name"));
  });
  return {{"trajectories", entries},
          {"complete", complete},
          {"uploads", logs_.uploads_json(trajectory_upload_kind().max_bytes)}};
}

Result<TrajectoryLibrary::Read> TrajectoryLibrary::read_file(const std::string& name,
                                                             const std::string& reference,
                                                             const std::atomic<bool>* cancel) {
  const ServedFolders folders = logs_.folders();
  const auto path = find_data_file(folders, name, has_trajectory_extension);
  if (!path) return no_such_trajectory(reference);
  const fs::path times = times_file_of(*path);
  std::error_code ignored;
  const bool timed = fs::exists(fs::symlink_status(times, ignored));
  if (timed && !folders.sources.check(times, "times")) {
    return Error{ErrorCode::kUnreadable,
                 reference + ": times.txt next to it is no regular file inside the data folders"};
  }
  std::vector<fs::path> files = {*path};
  if (timed) files.push_back(times);
  const std::string key = content_key(files);
  if (Read known = read_.find(key)) return known;
  Result<TrajectoryFile> file = read_trajectory(*path, kServedTrajectoryLimits, cancel);
  const auto shown = [&](const std::string& message) {
    return shown_without(path->parent_path(), "", shown_without(*path, reference, message));
  };
  if (!file) return Error{file.error().code, shown(file.error().message)};
  for (std::string& warning : file->warnings) warning = shown(warning);
  ServedTrajectory trajectory;
  trajectory.file = std::move(*file);
  trajectory.kind = "file";
  auto read = std::make_shared<const ServedTrajectory>(std::move(trajectory));
  read_.keep(key, read);
  return read;
}

Result<TrajectoryLibrary::Read> TrajectoryLibrary::read(const std::string& reference,
                                                        const std::atomic<bool>* cancel) {
  const Result<TrajectoryReference> parsed = trajectory_reference_from(reference);
  if (!parsed) return parsed.error();
  switch (parsed->kind) {
    case TrajectoryReference::Kind::kFile:
      return read_file(parsed->name, reference, cancel);
    case TrajectoryReference::Kind::kLog: {
      auto truth =
          logs_.trajectory(parsed->name, parsed->part, kServedTrajectoryLimits.max_poses, cancel);
      if (!truth) {
        if (truth.error().code == ErrorCode::kNotFound) return no_such_trajectory(reference);
        return truth.error();
      }
      ServedTrajectory trajectory;
      trajectory.file.trajectory = std::move(truth->trajectory);
      // They do not concern the order of poses, but all are shown.
      trajectory.file.warnings = std::move(truth->warnings);
      trajectory.kind = "log";
      trajectory.T_body_pose = Pose{};
      return std::make_shared<const ServedTrajectory>(std::move(trajectory));
    }
    case TrajectoryReference::Kind::kRun: {
      const Result<fs::path> folder = run_folder_(parsed->name);
      if (!folder) return no_such_trajectory(reference);
      auto trajectory = read_run_trajectory(*folder, parsed->part, reference, cancel);
      if (!trajectory) return trajectory.error();
      return std::make_shared<const ServedTrajectory>(std::move(*trajectory));
    }
  }
  return no_such_trajectory(reference);
}

Result<Json> TrajectoryLibrary::series(const std::string& reference,
                                       std::size_t points,
                                       const std::atomic<bool>* cancel) {
  const Result<Read> trajectory = read(reference, cancel);
  if (!trajectory) return trajectory.error();
  Json json = description_json(reference, **trajectory);
  json.update(pose_tables(**trajectory, points));
  return json;
}

Json TrajectoryLibrary::evaluate_one(const NamedTrajectory& truth,
                                     const std::string& reference,
                                     const EvaluationRequest& request,
                                     std::size_t& poses,
                                     const std::atomic<bool>* cancel) {
  const auto failed = [&](const Error& error) {
    return Json{{"name", reference}, {"error", error_json(error)}};
  };
  const Result<Read> estimate = read(reference, cancel);
  if (!estimate) return failed(estimate.error());
  poses += (*estimate)->file.trajectory.size();
  if (poses > kMaxEvaluatedPoses) {
    return failed({ErrorCode::kInvalidArgument,
                   "the trajectories up to this one have " + std::to_string(poses) +
                       " poses: one request may have at most " +
                       std::to_string(kMaxEvaluatedPoses)});
  }
  const NamedTrajectory named{reference, (*estimate)->file};
  const Result<FileScore> score = score_file(truth, named, request.score);
  if (!score) return failed(score.error());
  Json entry = json_from(*score);
  entry["name"] = reference;
  entry["run_outcome"] = outcome_json((*estimate)->outcome);
  if (request.points == 0) return entry;
  Json tables = Json::object();
  for (const auto& [mode, alignment] : score->score.alignments) {
    tables[evaluation::to_string(mode)] =
        error_tables(*score, mode, (*estimate)->T_body_pose, request.points);
  }
  entry["series"] = std::move(tables);
  return entry;
}

Result<Json> TrajectoryLibrary::evaluate(const EvaluationRequest& request,
                                         const std::atomic<bool>* cancel) {
  const std::size_t rows =
      request.estimates.size() * request.score.alignments.size() * request.points;
  if (rows > kMaxEvaluatedRows) {
    return Error{ErrorCode::kInvalidArgument,
                 "points = " + std::to_string(request.points) +
                     ": must be smaller: estimates times alignments times points is " +
                     std::to_string(rows) + ", and may be at most " +
                     std::to_string(kMaxEvaluatedRows)};
  }
  const Result<Read> truth = read(request.truth, cancel);
  if (!truth) return truth.error();
  std::size_t poses = (*truth)->file.trajectory.size();
  Json answer = {{"truth", description_json(request.truth, **truth)},
                 {"association", request.association},
                 {"estimates", Json::array()}};
  if (request.points > 0) answer["truth"]["series"] = pose_tables(**truth, request.points);
  const NamedTrajectory named{request.truth, (*truth)->file};
  for (const std::string& estimate : request.estimates) {
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "the client has gone"};
    answer["estimates"].push_back(evaluate_one(named, estimate, request, poses, cancel));
  }
  return answer;
}

Json TrajectoryLibrary::entry_of(const fs::path& upload) {
  const FileStamp stamp = FileStamp::of(upload);
  return list_entry({std::string(kUploadsLabel) + "/" + upload.filename().string(), upload, true},
                    formats_.of(upload, stamp),
                    stamp.size_bytes);
}

Status TrajectoryLibrary::remove(const std::string& reference) {
  const Result<TrajectoryReference> parsed = trajectory_reference_from(reference);
  if (!parsed) return parsed.error();
  if (parsed->kind != TrajectoryReference::Kind::kFile) {
    return Error{ErrorCode::kInvalidArgument,
                 "\"" + reference.substr(0, 200) + "\": only uploaded files can be deleted here"};
  }
  const auto path = find_data_file(logs_.folders(), parsed->name, has_trajectory_extension);
  if (!path) return no_such_trajectory(reference);
  return uploads().remove(*path);
}

}  // namespace overfly::server
