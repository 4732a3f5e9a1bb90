// The tick loop of one run: time, truth, camera, estimators, recorder.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/estimators/estimator_factory.hpp"
#include "server/estimators/estimator_worker.hpp"
#include "server/estimators/truth_feed.hpp"
#include "server/run/estimate_feedback.hpp"
#include "server/run/run_options.hpp"
#include "server/run/run_recorder.hpp"
#include "server/run/saturation_watch.hpp"
#include "server/timing/stage_timer.hpp"

namespace overfly::server {

class FlightRun {
 public:
  FlightRun(const Scenario& scenario, const RunOptions& options, RunRecorder& recorder);

  /// Flies to the end; all estimators have ended when it returns.
  /// Errors: kCancelled if it was stopped; any error of a part.
  Status fly();
  /// Stamp of the last frame; 0 before the first.
  [[nodiscard]] std::int64_t end_ns() const;
  /// Wall-clock measurements of the flight, for timings.json.
  [[nodiscard]] nlohmann::json timings() const;

 private:
  Status prepare_and_fly();
  Status calibrate_cameras();
  /// The camera as the estimators know it: its calibration if it has one, else the truth.
  [[nodiscard]] const CameraModel& given_model(std::size_t camera) const;
  Status open_maker();
  Status describe_world();
  Status open_estimators();
  void prepare_estimators();
  [[nodiscard]] Result<std::unique_ptr<VoPort>> open_estimator(const EstimatorSpec& spec);
  /// Sends the answers of an estimator to the vehicle. @return what is called with each answer
  std::function<void(const EstimateRecord&)> open_feedback(const EstimatorSpec& spec);
  Status describe();
  /// Unix time of t = 0, if it is now.
  [[nodiscard]] std::int64_t epoch_utc_ns() const;
  /// Records the estimators' remaining answers, their resource use and their parameters; also after
  /// an error.
  Status close_estimators();
  Status describe_use();

  /// Records what the flight has to report after it: gaps of a live vehicle, why it ended, its
  /// sensors, overexposed images.
  Status describe_end();

  Status fly_lockstep();
  Status fly_real_time();
  /// @param start_ns  start of the flight on the run's clock
  Status keep_pace(std::int64_t start_ns, PictureRate& pictures);
  /// Whether the flight continues after a frame.
  enum class Flight { kGoesOn, kEnded };
  /// Makes and records frame k and sends it to the estimators. After the end of a flight of unknown
  /// length it returns kEnded and makes no frame.
  Result<Flight> fly_frame(std::int64_t k, bool wait_for_estimators);
  /// Gives each estimator its camera's image, and records all cameras.
  Status deliver(MadeFrame& made);
  Status take_sensor_samples(MadeFrame& made);
  Status record_last_period();
  /// Compares the recorded image of a frame with the rendered one, and reports a lost one.
  Status judge_recorded_image(const MadeFrame& made);
  Status record_events();
  /// Records the events of the flight and the state of a live vehicle.
  /// Records the flight's events and the vehicle's reports up to a time, stamped no later than
  /// `latest_ns`.
  Status log_flight(std::int64_t until_ns, std::int64_t latest_ns);
  Status log_faults(std::int64_t t_ns);
  [[nodiscard]] bool cancelled() const;

  const Scenario& scenario_;
  const RunOptions& options_;
  RunRecorder& recorder_;
  RunClock& clock_;
  StageTimer stages_;
  std::int64_t begin_ns_ = 0;
  std::int64_t loop_begin_ns_ = 0;  ///< 0 = no frame yet

  /// By camera; empty before calibrate_cameras.
  std::vector<std::optional<CalibratedIntrinsics>> calibrated_;
  std::unique_ptr<FrameMaker> maker_;
  FaultNews fault_news_;
  SaturationWatch saturation_;
  /// Takes answers to a live vehicle; null without. Outlives the workers, which call it.
  std::unique_ptr<EstimateFeedback> feedback_;
  DurationList message_to_frame_;  ///< of a live vehicle
  std::int64_t late_tiles_ = 0;
  std::int64_t frames_with_late_tiles_ = 0;
  int problems_logged_ = 0;  ///< lost images in the log
  std::vector<std::unique_ptr<EstimatorWorker>> workers_;
  /// By estimator: samples of sensors that wait for its next frame.
  std::vector<SensorSamples> unsent_samples_;
  /// By camera; null where no test estimator needs the truth.
  std::vector<std::shared_ptr<TruthFeed>> truth_feeds_;
};

}  // namespace overfly::server
