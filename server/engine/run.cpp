#include "server/engine/run.hpp"

#include <utility>

#include "server/engine/flight_run.hpp"

namespace overfly::engine {

Result<RunResult> run_scenario(const Scenario& scenario, const RunOptions& options) {
  Result<std::unique_ptr<RunRecorder>> recorder =
      RunRecorder::create(options.folder, scenario, options.timeline, options.publish_images);
  if (!recorder) return recorder.error();
  FlightRun run(scenario, options, **recorder);
  const Status flown = run.fly();

  RunStatus status = RunStatus::kCompleted;
  std::string error;
  if (!flown && flown.error().code == ErrorCode::kCancelled) {
    status = RunStatus::kCancelled;
  } else if (!flown) {
    status = RunStatus::kFailed;
    error = flown.error().message;
  }
  const std::int64_t end_ns = run.end_ns();
  const Status logged = (*recorder)->log(
      end_ns, error.empty() ? "info" : "error", error.empty() ? to_string(status) : error);
  Result<nlohmann::json> metrics = (*recorder)->finish(status, error, run.timings());
  if (status == RunStatus::kFailed) return flown.error();
  if (!metrics) return metrics.error();
  if (!logged) return logged.error();
  return RunResult{(*recorder)->info(), std::move(*metrics)};
}

}  // namespace overfly::engine
