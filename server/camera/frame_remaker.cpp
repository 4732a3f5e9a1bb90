#include "server/camera/frame_remaker.hpp"

#include <utility>

#include "core/time.hpp"
#include "server/camera/truth.hpp"

namespace overfly::server {
namespace {

/// The exposure of a frame; empty if it is not known.
std::optional<sensor::ExposureSetting> setting_of(const FrameRow& row) {
  if (row.exposure_ns <= 0) return std::nullopt;
  return sensor::ExposureSetting{row.exposure_ns, row.gain};
}

}  // namespace

FrameRemaker::FrameRemaker(std::filesystem::path folder,
                           Scenario scenario,
                           std::shared_ptr<const terrain::World> world)
    : folder_(std::move(folder)), scenario_(std::move(scenario)), world_(std::move(world)) {}

Result<std::unique_ptr<FrameRemaker>> FrameRemaker::create(
    std::filesystem::path folder, Scenario scenario, std::shared_ptr<const terrain::World> world) {
  std::unique_ptr<FrameRemaker> maker(
      new FrameRemaker(std::move(folder), std::move(scenario), std::move(world)));
  for (std::size_t i = 0; i < maker->scenario_.cameras.size(); ++i) {
    auto unit = CameraUnit::create(maker->scenario_.cameras[i], i, maker->scenario_.seed);
    if (!unit) return unit.error();
    maker->cameras_.push_back(std::move(*unit));
  }
  maker->window_ = ShutterWindow::of(maker->cameras_);
  return maker;
}

Result<std::optional<std::vector<AircraftState>>> FrameRemaker::states_around(const FrameRow& row) {
  // A window never goes back in time: an earlier frame needs a new one.
  if (!truth_ || row.t_ns < asked_ns_) {
    auto source = open_flown_truth(folder_, {}, scenario_, *world_);
    if (!source) return source.error();
    truth_ = std::make_unique<TruthWindow>(std::move(*source));
  }
  asked_ns_ = row.t_ns;
  const std::int64_t next_ns = frame_time_ns(row.frame + 1, scenario_.rate);
  return truth_->around(row.t_ns, window_.half_ns, window_.raster_ns, next_ns);
}

Result<Image> FrameRemaker::read_again(const CameraSpec& camera, const FrameRow& row) {
  if (!recorded_) {
    auto source = open_image_source(camera, scenario_.sources, nullptr);
    if (!source) return source.error();
    recorded_ = std::move(*source);
  }
  if (row.source_image < 0 ||
      row.source_image >= static_cast<std::int64_t>(recorded_->stamps_ns().size())) {
    return Error{ErrorCode::kConflict,
                 camera.images->source.string() + ": no longer has the image of frame " +
                     std::to_string(row.frame)};
  }
  return recorded_->read(static_cast<std::size_t>(row.source_image));
}

Status FrameRemaker::check_camera(std::size_t camera) const {
  if (camera < cameras_.size()) return {};
  return Error{ErrorCode::kNotFound, "camera " + std::to_string(camera) + ": no such camera"};
}

Result<renderer::CameraRequest> FrameRemaker::request(std::size_t camera, const FrameRow& row) {
  if (Status status = check_camera(camera); !status) return status.error();
  if (is_real(camera)) {
    return renderer::CameraRequest::still(scenario_.cameras[camera].model,
                                          row.T_world_camera,
                                          row.t_ns,
                                          renderer::PixelFormat::kGrey8);
  }
  const auto states = states_around(row);
  if (!states) return states.error();
  if (!*states) {
    return Error{
        ErrorCode::kConflict,
        "frame " + std::to_string(row.frame) + ": the recorded flight ends before this frame"};
  }
  Result<renderer::CameraRequest> request =
      cameras_[camera]->request(**states, row.t_ns, setting_of(row));
  if (!request) return request.error();
  Status same = check_recorded_pose(row, row.t_ns, request->T_world_camera.at(row.t_ns));
  if (!same) return same.error();
  return request;
}

bool FrameRemaker::is_as_rendered(std::size_t camera, const FrameRow& row) const {
  if (camera >= cameras_.size() || is_real(camera) || scenario_.cameras[camera].sensor.enabled) {
    return false;
  }
  return FaultSchedule(scenario_).at(camera, row.frame, row.t_ns).names.empty();
}

Result<Image> FrameRemaker::make(std::size_t camera,
                                 const FrameRow& row,
                                 renderer::Renderer& renderer) {
  if (Status status = check_camera(camera); !status) return status.error();
  if (is_real(camera)) return read_again(scenario_.cameras[camera], row);
  const Result<renderer::CameraRequest> request = this->request(camera, row);
  if (!request) return request.error();
  Result<renderer::CameraFrame> drawn = renderer.render_camera(*request);
  if (!drawn) return drawn.error();
  const FrameFaults faults = FaultSchedule(scenario_).at(camera, row.frame, row.t_ns);
  CameraShot shot;
  const Status developed =
      cameras_[camera]->develop(std::move(*drawn), faults, row.frame, shot, setting_of(row));
  if (!developed) return developed.error();
  return std::move(shot.image);
}

Result<Image> FrameRemaker::make_ideal(std::size_t camera,
                                       const FrameRow& row,
                                       const Pose& T_world_camera,
                                       renderer::Renderer& renderer) {
  if (Status status = check_camera(camera); !status) return status.error();
  return cameras_[camera]->ideal(T_world_camera, row.t_ns, row.frame, setting_of(row), renderer);
}

}  // namespace overfly::server
