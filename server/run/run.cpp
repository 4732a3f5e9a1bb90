#include "server/run/run.hpp"

#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "server/run/flight_run.hpp"

namespace overfly::server {

namespace {

/// Converts an exception that ended a flight: out of memory, a thread that cannot be started, a
/// library error. It ends the flight, not the program.
Error error_from(const std::exception& exception) {
  if (dynamic_cast<const std::bad_alloc*>(&exception) != nullptr) {
    return {ErrorCode::kInternal, "not enough memory for this flight"};
  }
  if (const auto* system = dynamic_cast<const std::system_error*>(&exception)) {
    return {ErrorCode::kInternal,
            "the system refused a request (too many threads?): " + std::string(system->what())};
  }
  return {ErrorCode::kInternal, "failed unexpectedly: " + std::string(exception.what())};
}

/// Calls a step of a run; an exception becomes its error.
template <typename Step>
auto caught(const Step& step) -> decltype(step()) {
  try {
    return step();
  } catch (const std::exception& exception) {
    return error_from(exception);
  }
}

/// A flight and its result; its threads and processes have ended when this returns.
struct Flown {
  Status status;
  std::int64_t end_ns = 0;
  nlohmann::json timings = nlohmann::json::object();
};

Flown fly(const Scenario& scenario, const RunOptions& options, RunRecorder& recorder) {
  Flown flown;
  flown.status = caught([&]() -> Status {
    FlightRun run(scenario, options, recorder);
    const Status status = caught([&] { return run.fly(); });
    flown.end_ns = run.end_ns();
    flown.timings = run.timings();
    return status;
  });
  return flown;
}

/// Errors: as the flight's; as writing the folder.
Result<RunResult> record_end(const Flown& flown, RunRecorder& recorder) {
  RunStatus status = RunStatus::kCompleted;
  std::string error;
  if (!flown.status && flown.status.error().code == ErrorCode::kCancelled) {
    status = RunStatus::kCancelled;
  } else if (!flown.status) {
    status = RunStatus::kFailed;
    error = flown.status.error().message;
  }
  const Status logged = recorder.log(
      flown.end_ns, error.empty() ? "info" : "error", error.empty() ? to_string(status) : error);
  Result<RunMetrics> metrics = recorder.finish(status, error, flown.timings);
  if (status == RunStatus::kFailed) return flown.status.error();
  if (!metrics) return metrics.error();
  if (!logged) return logged.error();
  return RunResult{recorder.info(), std::move(*metrics)};
}

}  // namespace

Result<RunResult> run_scenario(const Scenario& scenario, const RunOptions& options) {
  Result<std::unique_ptr<RunRecorder>> recorder = caught([&] {
    return RunRecorder::create(options.folder, scenario, options.timeline, options.publish_images);
  });
  if (!recorder) return recorder.error();
  const Flown flown = fly(scenario, options, **recorder);
  Result<RunResult> result = caught([&] { return record_end(flown, **recorder); });
  if (!result) (*recorder)->give_up(result.error());
  return result;
}

}  // namespace overfly::server
