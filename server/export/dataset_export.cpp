#include "server/export/dataset_export.hpp"

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>

#include "middleware/lcm/findings.hpp"
#include "middleware/ros1/findings.hpp"
#include "server/camera/calibrated_camera.hpp"
#include "server/export/exported_samples.hpp"
#include "server/export/frame_sequence.hpp"
#include "server/files/build_info.hpp"
#include "server/files/whole_file.hpp"
#include "server/timing/run_clock.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool takes_one_camera(DatasetFormat format) {
  return format == DatasetFormat::kTumMono || format == DatasetFormat::kKitti;
}

/// Writes where the data set comes from and how to make it again.
Status write_origin(const ExportSource& source,
                    const ExportOptions& options,
                    const ExportSummary& summary,
                    FrameSequence& frames) {
  const terrain::World& world = frames.maker().world();
  const Geodetic& origin = world.tiles->frame().origin();
  const renderer::RendererInfo drawn_by = frames.maker().renderer().info();
  Json digests = Json::array();
  for (const auto& [file, digest] : world.data_hashes) {
    digests.push_back({{"file", file}, {"digest", digest}});
  }
  Json truth = Json::array();
  for (const TruthKind kind : options.truth) truth.push_back(to_string(kind));
  const Json about = {{"made_by", "overfly"},
                      {"version", version()},
                      {"commit", git_commit()},
                      {"format", to_string(options.format)},
                      {"truth", truth},
                      {"scenario", source.scenario.name},
                      {"first_frame", frames.first_frame()},
                      {"frames", summary.frames},
                      {"images", summary.images},
                      {"complete", !summary.cancelled},
                      {"renderer",
                       {{"backend", drawn_by.backend},
                        {"device", drawn_by.device},
                        {"software", drawn_by.software}}},
                      {"epoch_utc_ns", source.epoch_utc_ns},
                      {"flight", frames.maker().flight_description()},
                      {"world",
                       {{"name", world.spec.name},
                        {"attribution", world.tiles->attribution()},
                        {"data_hashes", digests},
                        {"origin",
                         {{"lat_deg", deg_from_rad(origin.lat_rad)},
                          {"lon_deg", deg_from_rad(origin.lon_rad)},
                          {"alt_ellipsoid_m", origin.alt_ellipsoid_m}}}}}};
  if (Status status = write_json(options.folder / "scenario.json", source.scenario.resolved);
      !status) {
    return status;
  }
  return write_json(options.folder / "overfly.json", about);
}

/// Errors: kConflict for a folder that is not empty.
Status prepare_folder(const fs::path& folder) {
  std::error_code failure;
  if (fs::exists(folder, failure) && !fs::is_empty(folder, failure)) {
    return Error{ErrorCode::kConflict,
                 folder.string() + ": is not empty; a data set needs an empty folder"};
  }
  return make_folder(folder);
}

Status check_export(const ExportOptions& options) {
  if (options.format == DatasetFormat::kLcm && !lcm::is_built_in()) {
    return Error{ErrorCode::kUnsupported,
                 "format = lcm: this build does not speak LCM: install liblcm-dev and liblcm-bin, "
                 "and build again"};
  }
  if (options.format == DatasetFormat::kRosbag && !ros1::is_built_in()) {
    return Error{
        ErrorCode::kUnsupported,
        "format = rosbag: this build writes no ROS bags: install librosbag-storage-dev, "
        "libroscpp-dev, libsensor-msgs-dev, libnav-msgs-dev and libtf2-msgs-dev, and build "
        "again"};
  }
  if (!(options.from_s >= 0.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "from = " + std::to_string(options.from_s) + " s: must be at least 0"};
  }
  if (options.video) {
    if (Status status = options.video->validate(); !status) return status;
  }
  return options.imu ? options.imu->validate() : Status();
}

std::int64_t images_in(const MadeFrame& frame) {
  return std::count_if(frame.shots.begin(), frame.shots.end(), [](const CameraShot& shot) {
    return shot.delivered;
  });
}

bool keeps_going(const ExportOptions& options) {
  return options.cancel == nullptr || !options.cancel->load();
}

bool was_cancelled(const Result<std::optional<MadeFrame>>& frame) {
  return !frame && frame.error().code == ErrorCode::kCancelled;
}

/// As the run's estimators were given it; for a scenario that was never flown the same, made again.
Result<CameraModel> calibrated_model(const ExportSource& source,
                                     const CameraSpec& camera,
                                     const ExportOptions& options) {
  if (source.run) {
    const auto recorded = source.run->calibrated.find(camera.name);
    if (recorded != source.run->calibrated.end()) return recorded->second;
  }
  const auto made =
      calibrate_camera(camera, source.scenario.seed, {options.notice, options.cancel});
  if (!made) return made.error();
  return made->model;
}

Result<DatasetPlan> make_plan(const ExportSource& source,
                              const ExportOptions& options,
                              FrameSequence& frames) {
  DatasetPlan plan;
  plan.folder = options.folder;
  plan.cameras = frames.cameras();
  for (CameraSpec& camera : plan.cameras) {
    plan.true_models.push_back(camera.model);
    if (!camera.calibrated) continue;
    const Result<CameraModel> given = calibrated_model(source, camera, options);
    if (!given) return given.error();
    camera.model = *given;
  }
  plan.rate = source.scenario.rate;
  plan.last_frame = frames.last_frame();
  plan.epoch_utc_ns = source.epoch_utc_ns;
  if (source.run) plan.estimates = source.run->estimates;
  if (options.format != DatasetFormat::kEuroc) return plan;
  const auto keep_going = [&] { return keeps_going(options); };
  Status measured = add_inertial_data(source, options.imu, frames, keep_going, plan);
  if (!measured) return measured.error();
  return plan;
}

/// All outputs of a frame.
class FrameOutputs {
 public:
  FrameOutputs(const ExportOptions& options,
               FrameMaker& maker,
               DatasetWriter& writer,
               StageTimer& stages)
      : writer_(writer),
        truth_(options.folder, options.truth, maker.renderer(), *maker.world().tiles),
        stages_(stages) {
    if (options.video) video_.emplace(options.folder / "video.webm", *options.video, maker);
  }

  Status add(const MadeFrame& frame) {
    const auto names = stages_.measure("write_images", [&] { return writer_.add(frame); });
    if (!names) return names.error();
    Status status = stages_.measure("write_truth", [&] { return truth_.add(frame, *names); });
    if (!status || !video_) return status;
    return stages_.measure("write_video", [&] { return video_->add(frame); });
  }

  Status finish(const FrameRate& rate) {
    Status status = writer_.finish();
    if (!status || !video_) return status;
    return video_->finish(rate);
  }

 private:
  DatasetWriter& writer_;
  TruthWriter truth_;
  std::optional<FlightVideo> video_;
  StageTimer& stages_;
};

Status write_frames(const ExportOptions& options,
                    const FrameRate& rate,
                    FrameSequence& frames,
                    FrameSamples& samples,
                    FrameOutputs& outputs,
                    ExportSummary& summary) {
  while (keeps_going(options)) {
    Result<std::optional<MadeFrame>> frame = frames.next();
    if (was_cancelled(frame)) break;  // what is complete is kept
    if (!frame) return frame.error();
    if (!frame->has_value()) return outputs.finish(rate);
    if (Status status = samples.add_to(**frame); !status) return status;
    if (Status status = outputs.add(**frame); !status) return status;
    ++summary.frames;
    summary.images += images_in(**frame);
    if (options.progress) options.progress(summary.frames, frames.count());
  }
  summary.cancelled = true;
  return outputs.finish(rate);
}

}  // namespace

Result<ExportSummary> export_dataset(const ExportSource& source, const ExportOptions& options) {
  if (Status status = check_export(options); !status) return status.error();
  if (Status status = prepare_folder(options.folder); !status) return status.error();
  StageTimer stages(machine_clock());
  FrameMakerOptions making;
  making.renderer_factory = options.renderer_factory;
  making.cancel = options.cancel;
  making.notice = options.notice;
  making.stages = &stages;
  // The samples of a run are in its folder.
  if (!source.run) making.sensing_from_utc_ns = source.epoch_utc_ns;
  FrameSpan span{options.from_s, options.to_s, options.cameras};
  if (takes_one_camera(options.format) && span.cameras.empty()) {
    span.cameras = {source.scenario.main_camera().name};
  }
  const auto frames = FrameSequence::open(source, span, making);
  if (!frames) return frames.error();
  const Result<DatasetPlan> plan = make_plan(source, options, **frames);
  if (!plan) return plan.error();
  const auto writer = create_dataset_writer(options.format, *plan);
  if (!writer) return writer.error();

  ExportSummary summary;
  summary.attribution = (*frames)->maker().world().tiles->attribution();
  FrameOutputs outputs(options, (*frames)->maker(), **writer, stages);
  auto samples = FrameSamples::open(source);
  if (!samples) return samples.error();
  Status status = write_frames(options, source.scenario.rate, **frames, *samples, outputs, summary);
  if (status) status = write_origin(source, options, summary, **frames);
  if (!status) return status.error();
  summary.stages = stages.summary();
  return summary;
}

}  // namespace overfly::server
