#include "server/record/run_records.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "server/files/file_field.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The cameras without frames; a run that failed before it had a camera keeps the default mount.
void add_cameras(const RunManifest& manifest, RunRecords& records) {
  if (!manifest.cameras.empty()) records.cameras.clear();
  for (const RunManifest::Camera& camera : manifest.cameras) {
    records.cameras.push_back({camera.name, camera.T_body_camera, {}});
  }
}

/// The estimators without answers, each with its camera.
void add_estimators(const RunManifest& manifest, RunRecords& records) {
  for (const RunManifest::Estimator& entry : manifest.estimators) {
    EstimatorRecords estimator;
    estimator.name = entry.name;
    estimator.type = entry.type;
    const auto named = std::find_if(
        records.cameras.begin(), records.cameras.end(), [&](const CameraRecords& camera) {
          return camera.name == entry.camera;
        });
    if (named != records.cameras.end()) {
      estimator.camera = static_cast<std::size_t>(named - records.cameras.begin());
    }
    records.estimators.push_back(std::move(estimator));
  }
}

/// Frame and time of a row that records a late frame; empty for other rows.
Result<std::optional<evaluation::FlightFrame>> late_frame_from(const Json& line) {
  return guarded_fields([&]() -> std::optional<evaluation::FlightFrame> {
    const FileField row(line);
    const auto flag = row.find("late");
    if (!flag || !flag->boolean()) return std::nullopt;
    return evaluation::FlightFrame{row.at("frame").integer(), row.at("t_ns").integer()};
  });
}

Status read_camera_rows(const fs::path& file,
                        CameraRecords& camera,
                        std::vector<evaluation::FlightFrame>& late_frames) {
  std::int64_t late_so_far = 0;
  return for_each_line(file, [&](const Json& line) -> Status {
    const auto late = late_frame_from(line);
    if (!late) return late.error();
    if (*late) {
      ++late_so_far;
      late_frames.push_back(**late);
      return {};
    }
    Result<FrameRow> record = frame_row_from(line, camera.T_body_camera);
    if (!record) return record.error();
    record->late_frames = late_so_far;
    camera.frames.push_back(std::move(*record));
    return {};
  });
}

Status read_estimator_rows(const fs::path& folder, EstimatorRecords& estimator) {
  return for_each_line(estimate_file(folder, estimator.name), [&](const Json& line) -> Status {
    Result<EstimateRecord> record = estimate_record_from(line);
    if (!record) return record.error();
    estimator.records.push_back(std::move(*record));
    return {};
  });
}

}  // namespace

Result<RunRecords> read_run_records(const fs::path& folder) {
  const Result<ReadManifest> manifest = read_run_manifest(folder);
  if (!manifest) return manifest.error();
  return read_run_records(folder, *manifest);
}

Result<RunRecords> read_run_records(const fs::path& folder, const ReadManifest& manifest) {
  for (const ManifestPart part : {ManifestPart::kCameras, ManifestPart::kEstimators}) {
    if (Status status = manifest.check(part); !status) return status.error();
  }
  RunRecords records;
  add_cameras(manifest.values, records);
  add_estimators(manifest.values, records);
  for (std::size_t i = 0; i < records.cameras.size(); ++i) {
    CameraRecords& camera = records.cameras[i];
    const Status status =
        read_camera_rows(CameraFiles(folder, i, camera.name).rows(), camera, records.late_frames);
    if (!status) return status.error();
  }
  for (EstimatorRecords& estimator : records.estimators) {
    if (Status status = read_estimator_rows(folder, estimator); !status) return status.error();
  }
  return records;
}

Result<Trajectory> truth_of(const CameraRecords& camera) {
  std::vector<StampedPose> poses;
  poses.reserve(camera.frames.size());
  for (const FrameRow& frame : camera.frames) {
    poses.push_back({frame.t_ns, frame.T_world_camera});
  }
  return Trajectory::from_poses(poses);
}

const FrameRow* frame_row(const CameraRecords& camera, std::int64_t frame) {
  const std::vector<FrameRow>& frames = camera.frames;
  const auto found = std::lower_bound(
      frames.begin(), frames.end(), frame, [](const FrameRow& record, std::int64_t number) {
        return record.frame < number;
      });
  return found != frames.end() && found->frame == frame ? &*found : nullptr;
}

std::vector<evaluation::FlightFrame> flight_frames(const RunRecords& records,
                                                   const CameraRecords& camera) {
  std::vector<evaluation::FlightFrame> drawn;
  for (const FrameRow& frame : camera.frames) {
    drawn.push_back({frame.frame, frame.t_ns});
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
  if (const FrameRow* frame = frame_row(records.camera_of(estimator), sample.frame)) {
    initial.true_depth_m = frame->axis_depth_m;
  }
  return initial;
}

}  // namespace overfly::server
