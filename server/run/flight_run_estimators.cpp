// FlightRun: the estimators before the first frame and after the last.
#include <utility>
#include <variant>

#include "server/record/run_folder.hpp"
#include "server/run/flight_run.hpp"
#include "server/run/frames_ahead.hpp"
#include "server/timing/cpu_affinity.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Port = Result<std::unique_ptr<VoPort>>;

/// Replaces an estimator that did not start: its first frame reports the reason.
class AbsentEstimator final : public VoPort {
 public:
  AbsentEstimator(std::string type, Error reason)
      : type_(std::move(type)), reason_(std::move(reason)) {}

  [[nodiscard]] std::string type() const override { return type_; }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return {};
  }
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& /*frame*/) override {
    return Error{ErrorCode::kInternal, reason_.message};
  }
  void set_debug(bool /*wanted*/) override {}

 private:
  std::string type_;
  Error reason_;
};

/// An invalid value in the scenario ends the run. An error of an outside estimator, or a
/// requirement of it that this machine lacks, ends only that estimator.
bool ends_the_run(const Error& error) {
  return error.code == ErrorCode::kInvalidArgument || error.code == ErrorCode::kCancelled;
}

/// Created for an estimator that has files to write.
Result<fs::path> output_folder(const fs::path& run_folder, const EstimatorSpec& spec) {
  if (spec.type != "process") return fs::path();
  fs::path folder = fs::absolute(estimator_output_folder(run_folder, spec.name));
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return Error{ErrorCode::kIo, folder.string() + ": " + failure.message()};
  return folder;
}

}  // namespace

Port FlightRun::open_estimator(const EstimatorSpec& spec) {
  if (options_.estimator_factory) return options_.estimator_factory(spec);
  if (options_.notice && is_outside_estimator(spec.type)) {
    options_.notice("starting estimator " + spec.name);
  }
  ToyTruthAt truth;
  if (is_test_estimator(spec.type)) {
    std::shared_ptr<TruthFeed>& feed = truth_feeds_[spec.camera];
    if (!feed) feed = std::make_shared<TruthFeed>();
    truth = [feed](std::int64_t stamp_ns) { return feed->at(stamp_ns); };
  }
  const Result<fs::path> folder = output_folder(options_.folder, spec);
  if (!folder) return folder.error();
  // Logs may have samples of sensors.
  const bool flies_log = std::holds_alternative<LoggedFlight>(scenario_.flight);
  const EstimatorSetting setting{scenario_.seed,
                                 scenario_.pacing == Pacing::kLockstep,
                                 *folder,
                                 scenario_.rate.hz(),
                                 options_.cancel,
                                 scenario_.has_sensors() || flies_log,
                                 scenario_.cameras[spec.camera].T_body_camera};
  if (is_outside_estimator(spec.type)) return create_estimator(spec, setting, truth);
  // Also binds the threads that a native estimator starts at once.
  const AffinityGuard guard;
  if (Status status = bind_thread(spec.cpus); !status) {
    return status.error().in("estimator \"" + spec.name + "\"");
  }
  return create_estimator(spec, setting, truth);
}

std::function<void(const EstimateRecord&)> FlightRun::open_feedback(const EstimatorSpec& spec) {
  std::shared_ptr<EstimateReceiver> receiver = maker_->estimate_receiver();
  if (!receiver) return {};
  feedback_ = std::make_unique<EstimateFeedback>(std::move(receiver),
                                                 scenario_.cameras[spec.camera].T_body_camera);
  return [this](const EstimateRecord& record) { feedback_->take(record); };
}

Status FlightRun::open_estimators() {
  return stages_.measure("open_estimators", [&]() -> Status {
    for (std::size_t i = 0; i < scenario_.estimators.size(); ++i) {
      if (cancelled()) return Error{ErrorCode::kCancelled, "cancelled"};
      const EstimatorSpec& spec = scenario_.estimators[i];
      Port port = open_estimator(spec);
      if (!port) {
        if (ends_the_run(port.error())) return port.error();
        recorder_.manifest().estimators[i].start_error = port.error().message;
        port = std::unique_ptr<VoPort>(
            std::make_unique<AbsentEstimator>(spec.type, port.error().in("did not start")));
      }
      EstimatorWorkerOptions worker;
      worker.debug_hz = scenario_.record_debug_hz;
      worker.throttle_hz = spec.throttle_hz;
      worker.cancel = options_.cancel;
      // In addition to the pending frames, the one whose answer the next record waits for.
      if (scenario_.pacing == Pacing::kLockstep) {
        worker.frames_ahead = lockstep_frames_ahead(scenario_) + 1;
      }
      worker.in_process = !is_outside_estimator(spec.type);
      if (worker.in_process) worker.cpus = spec.cpus;
      if (scenario_.feedback_estimator == i) worker.answered = open_feedback(spec);
      workers_.push_back(
          std::make_unique<EstimatorWorker>(std::move(*port), std::move(worker), clock_));
    }
    prepare_estimators();
    return {};
  });
}

void FlightRun::prepare_estimators() {
  // All enter first: a simulated clock must not advance while only some have entered
  clock_.enter();
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    const std::size_t camera = scenario_.estimators[i].camera;
    VoFrame first;
    first.camera_id = scenario_.cameras[camera].name;
    first.intrinsics = given_model(camera).pinhole();
    first.distortion = given_model(camera).distortion();
    workers_[i]->prepare(std::move(first));
  }
  clock_.leave();
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    workers_[i]->wait_until_idle();
    recorder_.manifest().estimators[i].parameters = workers_[i]->effective_parameters();
  }
}

Status FlightRun::close_estimators() {
  // A flight that was stopped ends with the last frame of its record.
  const std::int64_t last = last_recorded_frame();
  stages_.measure("wait_for_estimators", [&] {
    for (auto& worker : workers_) worker->forget_after(last);
    for (auto& worker : workers_) worker->wait_until_idle();
    return 0;
  });
  const Status recorded = record_events(last);
  if (feedback_) {
    Status logged = recorder_.log(end_ns(), "info", feedback_->finish());
    if (!logged) return logged;
  }
  const Status described = describe_use();
  return recorded ? described : recorded;
}

Status FlightRun::describe_use() {
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    recorder_.set_use(i, workers_[i]->use());
    RunManifest::Estimator& entry = recorder_.manifest().estimators[i];
    const RunManifest::Parameters at_end = workers_[i]->effective_parameters();
    const RunManifest::Parameters at_begin = entry.parameters.value_or(RunManifest::Parameters());
    for (const auto& [name, value] : at_end) {
      const auto known = at_begin.find(name);
      const std::string was = known != at_begin.end() ? known->second : "";
      // An estimator may report some parameters only after it knows its camera: that is not a
      // change.
      if (was.empty() || was == value) continue;
      Status logged = recorder_.log(end_ns(),
                                    "warning",
                                    scenario_.estimators[i].name + ": parameter " + name + " is " +
                                        value + " at the end, but at the start it was " + was);
      if (!logged) return logged;
    }
    entry.parameters_at_end = at_end;
  }
  return {};
}

}  // namespace overfly::server
