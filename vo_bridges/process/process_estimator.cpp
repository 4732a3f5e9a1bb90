#include "vo_bridges/process/process_estimator.hpp"

#include <optional>
#include <utility>

#include "vo_bridges/process/options.hpp"
#include "vo_bridges/process/session.hpp"

namespace overfly {

namespace {

class ProcessEstimator final : public VoPort {
 public:
  explicit ProcessEstimator(std::unique_ptr<process::Session> session)
      : session_(std::move(session)) {}

  [[nodiscard]] std::string type() const override { return "process"; }

  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return session_->parameters();
  }

  [[nodiscard]] Status prepare(const VoFrame& first) override {
    Status sound = first.intrinsics.validate();
    if (sound) sound = CameraModel(first.intrinsics, first.distortion).validate();
    if (!sound) return sound.error().in("frame " + std::to_string(first.index));
    return calibrate(first);
  }

  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override {
    const VoFrame* const previous = previous_ ? &*previous_ : nullptr;
    if (Status status = validate_vo_frame(frame, previous); !status) return status.error();
    if (Status status = calibrate(frame); !status) return status.error();
    Result<std::optional<VoEstimate>> answer = session_->track(frame, debug_);
    if (!answer) return answer.error();
    previous_ = without_image(frame);
    if (!*answer) return unanswered(frame);
    tracked_ = tracked_ || (*answer)->sample.state == TrackingState::kTracking;
    map_id_ = (*answer)->sample.map_id;
    return std::move(**answer);
  }

  void set_debug(bool wanted) override { debug_ = wanted; }

  [[nodiscard]] std::vector<std::string> take_log() override { return session_->take_log(); }

  [[nodiscard]] std::optional<ResourceUse> resource_use() const override {
    return session_->resource_use();
  }

 private:
  static VoFrame without_image(const VoFrame& frame) {
    VoFrame copy = frame;
    copy.image.reset();
    copy.sensors = {};
    return copy;
  }

  /// Sends the camera unless it was already sent.
  [[nodiscard]] Status calibrate(const VoFrame& frame) {
    if (calibrated_for(frame)) return {};
    if (Status status = session_->calibrate(frame); !status) return status;
    calibration_ = without_image(frame);
    return {};
  }

  [[nodiscard]] bool calibrated_for(const VoFrame& frame) const {
    if (!calibration_) return false;
    const PinholeCamera& told = calibration_->intrinsics;
    const PinholeCamera& now = frame.intrinsics;
    return told.width_px == now.width_px && told.height_px == now.height_px &&
           told.K() == now.K() && calibration_->camera_id == frame.camera_id &&
           calibration_->distortion.model == frame.distortion.model &&
           calibration_->distortion.k == frame.distortion.k;
  }

  [[nodiscard]] VoEstimate unanswered(const VoFrame& frame) const {
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    estimate.sample.state = tracked_ ? TrackingState::kLost : TrackingState::kInitialising;
    estimate.sample.map_id = map_id_;
    estimate.counters["unanswered"] = 1.0;
    return estimate;
  }

  std::unique_ptr<process::Session> session_;
  std::optional<VoFrame> previous_;
  std::optional<VoFrame> calibration_;  // the frame whose camera was sent
  bool debug_ = false;
  bool tracked_ = false;
  int map_id_ = 0;
};

}  // namespace

Result<std::unique_ptr<VoPort>> create_process_estimator(const ProcessEstimatorOptions& options) {
  if (Status status = process::validate(options); !status) return status.error();
  Result<std::unique_ptr<process::Session>> session = process::Session::open(options);
  if (!session) return session.error();
  return std::unique_ptr<VoPort>(std::make_unique<ProcessEstimator>(std::move(session).value()));
}

}  // namespace overfly
