// The tick loop of one run: time, truth, camera, estimators, recorder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
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
#include "server/frame_cache/frame_cache.hpp"
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

  /// A frame on its way from the cameras to the record.
  struct Pending {
    MadeFrame made;
    /// By shot: its image, moved out of the shot, as recorded; never null.
    std::vector<std::shared_ptr<const Image>> images;
    std::vector<std::optional<std::uint32_t>> image_crc32;  ///< by shot, of the grey image
    std::vector<FlightEvent> events;                        ///< of the flight, up to the frame
    std::optional<VehicleStatus> vehicle;
  };

  /// Frames are made ahead of the estimators, and recorded in the order in which they would be
  /// without: answers to a frame, then the next frame.
  Status fly_lockstep();
  /// Index; kNoFrame before the first.
  [[nodiscard]] std::int64_t last_recorded_frame() const;
  /// Records the pending frames whose predecessors have been answered, and waits for answers until
  /// at most `most` frames are pending.
  Status record_pending(std::deque<Pending>& pending, std::size_t most);
  Status fly_real_time();
  /// @param start_ns  start of the flight on the run's clock
  Status keep_pace(std::int64_t start_ns, PictureRate& pictures);
  /// Makes frame k; empty after the end of a flight of unknown length.
  Result<std::optional<Pending>> make_frame(std::int64_t k);
  /// After the last frame or a frame that could not be made: what ended the flight is an event
  /// behind the last frame.
  Status log_end_of_flight();
  /// Gives each estimator its camera's image and the samples of the sensors.
  void send(Pending& frame);
  /// Records what happened up to a frame, except for the estimators' events, and its cameras.
  Status record(Pending& frame);
  Status record_shot(const Pending& frame, std::size_t shot);
  Status record_last_period();
  /// Compares the recorded image of a frame with the rendered one, and reports a lost one.
  Status judge_recorded_image(const Pending& frame);
  /// Records the estimators' answers up to a frame, and their log lines.
  Status record_events(std::int64_t frame);
  /// Records the flight's events and the vehicle's reports, stamped no later than `latest_ns`.
  Status log_flight(const std::vector<FlightEvent>& events,
                    std::optional<VehicleStatus> vehicle,
                    std::int64_t latest_ns);
  /// As above, of those up to a time.
  Status log_flight(std::int64_t until_ns, std::int64_t latest_ns);
  Status log_faults(std::int64_t t_ns);
  [[nodiscard]] bool cancelled() const;

  static constexpr std::int64_t kNoFrame = -1;

  const Scenario& scenario_;
  const RunOptions& options_;
  RunRecorder& recorder_;
  RunClock& clock_;
  StageTimer stages_;
  std::int64_t begin_ns_ = 0;
  std::int64_t loop_begin_ns_ = 0;  ///< 0 = no frame yet

  /// By camera; empty before calibrate_cameras.
  std::vector<std::optional<CalibratedIntrinsics>> calibrated_;
  std::unique_ptr<FrameCache> frame_cache_;  ///< null without; outlives the maker, which uses it
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
