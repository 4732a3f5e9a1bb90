// LCM event logs: flight.lcm contains the messages that an estimator on LCM receives
// (vo_bridges/lcm/README.md), the true poses, and of a run the answers of its estimators.
#include <algorithm>
#include <limits>
#include <optional>

#include "middleware/lcm/log_writer.hpp"
#include "server/export/dataset_writer.hpp"
#include "server/files/number_text.hpp"

namespace overfly::server {
namespace {

constexpr std::int64_t kCalibrationPeriodNs = 1'000'000'000;
constexpr std::int64_t kNeverNs = std::numeric_limits<std::int64_t>::max();

class LcmWriter final : public DatasetWriter {
 public:
  LcmWriter(const DatasetPlan& plan, std::unique_ptr<lcm::LogWriter> log)
      : cameras_(plan.cameras), estimates_(plan.estimates), log_(std::move(log)) {
    next_.resize(estimates_.size());
    for (const CameraSpec& camera : cameras_) {
      // The first camera uses the door's own channels, so that its log can be played to an
      // estimator directly.
      prefixes_.push_back(prefixes_.empty() ? "OVERFLY_" : "OVERFLY_" + camera.name + "_");
    }
  }

  Result<std::vector<std::string>> add(const MadeFrame& frame) override {
    if (!next_calibration_ns_ || frame.t_ns >= *next_calibration_ns_) {
      if (Status status = calibrate(frame); !status) return status.error();
      next_calibration_ns_ = frame.t_ns + kCalibrationPeriodNs;
    }
    // On the channels of the first camera: an estimator of another one hears only its own prefix.
    Status written = log_->write_samples(prefixes_.front(), frame.sensors);
    if (!written) return written.error();
    std::vector<std::string> names(frame.shots.size());
    for (std::size_t i = 0; i < frame.shots.size(); ++i) {
      const CameraShot& shot = frame.shots[i];
      if (!shot.delivered) continue;
      names[i] = padded(frame.frame, 6);
      if (Status status = write_shot(prefixes_[i], frame, shot); !status) return status.error();
    }
    if (Status status = write_estimates(frame.frame); !status) return status.error();
    return names;
  }

  Status finish() override { return log_->finish(); }

 private:
  /// Events of a log are in order of time, and the calibration precedes the frame's samples.
  Status calibrate(const MadeFrame& frame) {
    const std::int64_t earliest_ns = first_available_ns(frame.sensors).value_or(kNeverNs);
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      Status status = log_->write_calibration(prefixes_[i],
                                              cameras_[i].name,
                                              cameras_[i].model,
                                              std::min(frame.shots[i].stamp_ns, earliest_ns));
      if (!status) return status;
    }
    return {};
  }

  Status write_shot(const std::string& prefix, const MadeFrame& frame, const CameraShot& shot) {
    const bool colour = shot.image.channels != 1;
    const Image grey = colour ? grey_of(shot.image) : Image{};
    Status status = log_->write_image(
        prefix, {frame.frame, shot.stamp_ns, shot.setting.exposure_ns, colour ? grey : shot.image});
    if (!status) return status;
    return log_->write_truth(prefix,
                             {frame.frame, frame.t_ns, shot.stamp_ns, shot.drawn.T_world_camera});
  }

  Status write_estimates(std::int64_t frame) {
    for (std::size_t i = 0; i < estimates_.size(); ++i) {
      const PlannedEstimate& estimate = estimates_[i];
      const std::string& name = estimate.track.name;
      const std::vector<EstimateSample>& samples = estimate.track.samples;
      while (next_[i] < samples.size() && samples[next_[i]].frame < frame) ++next_[i];
      if (next_[i] == samples.size() || samples[next_[i]].frame != frame) continue;
      const EstimateSample& sample = samples[next_[i]];
      Status status = log_->write_estimate(name, sample);
      const bool aligned = estimate.S_world_vo && sample.state == TrackingState::kTracking &&
                           sample.map_id == estimate.map_id;
      if (status && aligned) {
        status =
            log_->write_world_estimate(name, sample, *estimate.S_world_vo * sample.T_vo_camera);
      }
      if (!status) return status;
    }
    return {};
  }

  std::vector<CameraSpec> cameras_;
  std::vector<PlannedEstimate> estimates_;
  std::vector<std::size_t> next_;  ///< sample, by estimator
  std::unique_ptr<lcm::LogWriter> log_;
  std::vector<std::string> prefixes_;  ///< channel prefixes, one for each camera
  std::optional<std::int64_t> next_calibration_ns_;
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> create_lcm_writer(const DatasetPlan& plan) {
  auto log = lcm::LogWriter::create(plan.folder / "flight.lcm", plan.epoch_utc_ns);
  if (!log) return log.error().in("lcm");
  return std::unique_ptr<DatasetWriter>(std::make_unique<LcmWriter>(plan, std::move(*log)));
}

}  // namespace overfly::server
