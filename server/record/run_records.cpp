#include "server/record/run_records.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "server/files/file_field.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Converts each line of a file to a row; `read` returns a Result.
template <typename Read>
Status for_each_row(const fs::path& file, const Read& read) {
  const Result<std::vector<Json>> lines = read_lines(file);
  if (!lines) return lines.error();
  for (std::size_t i = 0; i < lines->size(); ++i) {
    if (Status status = read((*lines)[i]); !status) {
      return status.error().in(file.string() + ", row " + std::to_string(i + 1));
    }
  }
  return {};
}

Pose read_manifest_pose(const FileField& field) {
  const Result<Pose> pose = pose_from(field.value());
  if (!pose) field.fault("be a pose (" + pose.error().message + ")");
  return *pose;
}

/// Reads the cameras, and which camera each estimator used. A run that failed before it had a
/// camera keeps the default mount.
void read_recorded_cameras(const FileField& manifest, RunRecords& records) {
  if (const auto camera = manifest.find("camera")) {
    if (const auto mount = camera->find("T_body_camera")) {
      records.T_body_camera = read_manifest_pose(*mount);
    }
  }
  std::vector<std::string> names;
  if (const auto cameras = manifest.find("cameras")) {
    for (const FileField& camera : cameras->items()) {
      names.push_back(camera.at("name").plain_name());
      if (names.size() == 1) continue;
      records.other_cameras.push_back(
          {names.back(), read_manifest_pose(camera.at("T_body_camera")), {}});
    }
  }
  for (const FileField& entry : manifest.at("estimators").items()) {
    EstimatorRecords estimator;
    estimator.name = entry.at("name").plain_name();
    estimator.type = entry.at("type").text();
    const auto camera = entry.find("camera");
    const auto named = std::find(names.begin(), names.end(), camera ? camera->text() : "");
    if (named != names.end()) {
      estimator.camera = static_cast<std::size_t>(named - names.begin());
    }
    records.estimators.push_back(std::move(estimator));
  }
}

Status read_frames(const fs::path& folder, RunRecords& records) {
  return for_each_row(frames_file(folder), [&](const Json& line) -> Status {
    const auto late = guarded_fields([&]() -> std::optional<evaluation::FlightFrame> {
      const FileField row(line);
      const auto flag = row.find("late");
      if (!flag || !flag->boolean()) return std::nullopt;
      return evaluation::FlightFrame{row.at("frame").integer(), row.at("t_ns").integer()};
    });
    if (!late) return late.error();
    if (*late) {
      records.late_frames.push_back(**late);
      return {};
    }
    Result<FrameRecord> record = frame_record_from(line, records.T_body_camera);
    if (!record) return record.error();
    records.frames.push_back(std::move(*record));
    return {};
  });
}

Status read_camera_frames(const fs::path& folder, CameraRecords& camera) {
  const fs::path file = camera_frames_file(folder, camera.name);
  return for_each_row(file, [&](const Json& line) -> Status {
    Result<FrameRecord> record = frame_record_from(line, camera.T_body_camera);
    if (!record) return record.error();
    camera.frames.push_back(std::move(*record));
    return {};
  });
}

Status read_estimator_rows(const fs::path& folder, EstimatorRecords& estimator) {
  return for_each_row(estimate_file(folder, estimator.name), [&](const Json& line) -> Status {
    Result<EstimateRecord> record = estimate_record_from(line);
    if (!record) return record.error();
    estimator.records.push_back(std::move(*record));
    return {};
  });
}

}  // namespace

Result<RunRecords> read_run_records(const fs::path& folder) {
  const Result<Json> manifest = read_json(manifest_file(folder));
  if (!manifest) return manifest.error();
  RunRecords records;
  const auto read = guarded_fields([&] {
    read_recorded_cameras(FileField(*manifest), records);
    return true;
  });
  if (!read) return read.error().in(manifest_file(folder).string());
  if (Status status = read_frames(folder, records); !status) return status.error();
  for (CameraRecords& camera : records.other_cameras) {
    if (Status status = read_camera_frames(folder, camera); !status) return status.error();
  }
  for (EstimatorRecords& estimator : records.estimators) {
    if (Status status = read_estimator_rows(folder, estimator); !status) return status.error();
  }
  return records;
}

Result<Trajectory> truth_of(const RunRecords& records, std::size_t camera) {
  std::vector<StampedPose> poses;
  poses.reserve(records.frames_of(camera).size());
  for (const FrameRecord& frame : records.frames_of(camera)) {
    poses.push_back({frame.row.t_ns, frame.row.T_world_camera});
  }
  return Trajectory::from_poses(poses);
}

const FrameRecord* frame_record(const RunRecords& records, std::size_t camera, std::int64_t frame) {
  const std::vector<FrameRecord>& frames = records.frames_of(camera);
  const auto found = std::lower_bound(
      frames.begin(), frames.end(), frame, [](const FrameRecord& record, std::int64_t number) {
        return record.row.frame < number;
      });
  return found != frames.end() && found->row.frame == frame ? &*found : nullptr;
}

std::vector<evaluation::FlightFrame> flight_frames(const RunRecords& records, std::size_t camera) {
  std::vector<evaluation::FlightFrame> drawn;
  for (const FrameRecord& frame : records.frames_of(camera)) {
    drawn.push_back({frame.row.frame, frame.row.t_ns});
  }
  const std::vector<evaluation::FlightFrame>& late = records.late_frames;
  std::vector<evaluation::FlightFrame> all;
  std::merge(drawn.begin(),
             drawn.end(),
             late.begin(),
             late.end(),
             std::back_inserter(all),
             [](const auto& a, const auto& b) { return a.frame < b.frame; });
  return all;
}

EstimateTrack track_of(const EstimatorRecords& estimator) {
  EstimateTrack track;
  track.name = estimator.name;
  for (const EstimateRecord& record : estimator.records) {
    if (!record.dropped) track.samples.push_back(record.sample);
  }
  return track;
}

std::optional<InitialFrame> initial_frame(const RunRecords& records,
                                          const EstimatorRecords& estimator) {
  std::map<int, std::int64_t> tracked;
  std::map<int, const EstimateRecord*> first;
  for (const EstimateRecord& record : estimator.records) {
    if (record.dropped || record.sample.state != TrackingState::kTracking) continue;
    ++tracked[record.sample.map_id];
    first.try_emplace(record.sample.map_id, &record);
  }
  if (tracked.empty()) return std::nullopt;
  const auto longest =
      std::max_element(tracked.begin(), tracked.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      });
  const EstimateSample& sample = first.at(longest->first)->sample;
  InitialFrame initial{sample.frame, sample.map_id, std::nullopt, sample.scene_depth};
  if (const FrameRecord* frame = frame_record(records, estimator.camera, sample.frame)) {
    initial.true_depth_m = frame->axis_depth_m;
  }
  return initial;
}

}  // namespace overfly::engine
