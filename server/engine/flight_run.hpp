// One run's tick loop: time, truth, camera, estimators, recorder.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/truth_source.hpp"
#include "server/engine/estimator_factory.hpp"
#include "server/engine/estimator_worker.hpp"
#include "server/engine/run.hpp"
#include "server/engine/run_recorder.hpp"
#include "server/engine/stage_timer.hpp"
#include "terrain/world.hpp"

namespace overfly::engine {

class FlightRun {
 public:
  FlightRun(const Scenario& scenario, const RunOptions& options, RunRecorder& recorder);

  /// Flies to the end. Errors: kCancelled when it was stopped; whatever a part says.
  Status fly();
  /// Stamp of the last frame; 0 before the first.
  [[nodiscard]] std::int64_t end_ns() const;
  /// Wall-clock facts of what was flown, for timings.json.
  [[nodiscard]] nlohmann::json timings() const;

 private:
  Status open_world();
  Status plan_flight();
  Status open_renderer();
  Status open_estimators();
  Status describe();
  [[nodiscard]] Result<ToyTruth> toy_truth(double scene_depth_m) const;

  Status fly_lockstep();
  Status fly_real_time();
  /// Truth, image and record of frame k, and its way to the estimators.
  /// Errors: kNotFound at the end of a flight whose length was not known.
  Status fly_frame(std::int64_t k, bool wait_for_estimators);
  Status record_events();
  [[nodiscard]] bool cancelled() const;

  const Scenario& scenario_;
  const RunOptions& options_;
  RunRecorder& recorder_;
  RunClock& clock_;
  StageTimer stages_;
  std::int64_t begin_ns_ = 0;
  std::int64_t loop_begin_ns_ = 0;  ///< 0 = no frame yet

  std::shared_ptr<const terrain::World> world_;
  std::unique_ptr<TruthSource> truth_;
  std::int64_t frames_total_ = 0;
  Pose T_body_camera_{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  std::unique_ptr<renderer::Renderer> renderer_;
  std::vector<std::unique_ptr<EstimatorWorker>> workers_;
};

}  // namespace overfly::engine
