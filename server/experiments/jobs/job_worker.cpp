#include "server/experiments/jobs/job_worker.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <system_error>
#include <utility>

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;

/// Between two looks for jobs.
constexpr std::chrono::milliseconds kLookPeriod{500};

std::chrono::steady_clock::duration seconds_of(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

/// "host-1234-9f3a2c01": readable, and different also where process numbers repeat.
std::string new_worker_name() {
  std::array<char, 64> host{};
  std::string name = ::gethostname(host.data(), host.size() - 1) == 0 ? host.data() : "host";
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  return name + "-" + std::to_string(::getpid()) + "-" + random_name();
}

}  // namespace

JobWorker::JobWorker(WorkerOptions options)
    : options_(std::move(options)),
      folder_(options_.sweep),
      budget_(MemoryBudget::of_machine(false)),
      processes_(std::make_unique<FlightProcesses>(
          options_.program, frame_cache_options(options_.frame_cache, true))),
      next_beat_(Clock::now()),
      next_look_(next_beat_),
      busy_(next_beat_),
      written_(next_beat_) {
  state_.name = new_worker_name();
}

Result<JobWorker> JobWorker::start(WorkerOptions options) {
  std::error_code error;
  if (!fs::exists(options.sweep / "sweep.json", error)) {
    return Error{ErrorCode::kNotFound,
                 options.sweep.string() + ": is no folder of a sweep (sweep.json is missing)"};
  }
  JobWorker worker(std::move(options));
  if (Status status = worker.folder_.create(); !status) return status.error();
  if (Status status = worker.beat(); !status) return status.error();
  return worker;
}

void JobWorker::note(const std::string& text) const {
  if (options_.note) options_.note(text);
}

Status JobWorker::tolerate(const Status& status) {
  if (status) return {};
  if (Clock::now() - written_ > seconds_of(options_.silence_s)) return status;
  if (!complained_ && options_.warn) options_.warn(status.error().message + "; tried again");
  complained_ = true;
  return {};
}

Status JobWorker::beat() {
  ++state_.beat;
  state_.jobs.clear();
  for (const auto& [job, memory] : flights_) state_.jobs.push_back(job);
  for (const JobDelivery& delivery : deliveries_) state_.jobs.push_back(delivery.job);
  next_beat_ = Clock::now() + seconds_of(options_.beat_s);
  Status status = folder_.show_worker(state_);
  if (status) has_written();
  return status;
}

void JobWorker::has_written() {
  written_ = Clock::now();
  complained_ = false;
}

bool JobWorker::is_withdrawn(const std::string& job) const {
  const Result<std::optional<std::string>> holder = folder_.holder(job);
  return holder && *holder != state_.name;
}

void JobWorker::give_up_withdrawn() {
  for (auto flight = flights_.begin(); flight != flights_.end();) {
    const std::string& job = flight->first;
    if (!is_withdrawn(job)) {
      ++flight;
      continue;
    }
    note("flight " + job + " was taken back");
    processes_->kill(job);
    (void)folder_.remove_flight(job);  // What remains, the next controller removes.
    flight = flights_.erase(flight);
  }
}

Status JobWorker::take_ended() {
  for (;;) {
    const Result<std::optional<EndedFlight>> ended = processes_->ended();
    if (!ended) return ended.error();
    if (!*ended) return {};
    const EndedFlight& flight = **ended;
    deliveries_.push_back(
        {flight.id, state_.name, flight.duration_s, flight.timed_out, flight.reason});
    flights_.erase(flight.id);
    next_look_ = Clock::now();
  }
}

Status JobWorker::deliver() {
  while (!deliveries_.empty()) {
    const JobDelivery& delivery = deliveries_.back();
    // The flight of a worker that was stopped for long may have been given to another one.
    if (!is_withdrawn(delivery.job)) {
      if (Status status = folder_.deliver(delivery); !status) return status;
      has_written();
      ++flown_;
      note("flight " + delivery.job + " " +
           (delivery.reason.empty() ? "completed" : "ended with " + delivery.reason));
    }
    deliveries_.pop_back();
  }
  return {};
}

std::string JobWorker::refusal(const OpenJob& job) const {
  if (job.version != options_.version) {
    return "is for version " + job.version + " of the program; this is " + options_.version;
  }
  if (!budget_.holds(job.memory)) return "needs more memory than this machine has";
  return "";
}

bool JobWorker::has_memory(RunMemory memory) const {
  for (const auto& [job, other] : flights_) memory += other;
  return flights_.empty() || budget_.holds(memory);
}

Status JobWorker::take_jobs() {
  const Result<std::vector<std::string>> open = folder_.open_jobs();
  if (!open) return open.error();
  const Result<std::vector<std::string>> taken_jobs = folder_.taken();
  if (!taken_jobs) return taken_jobs.error();
  for (const std::string& id : *open) {
    if (flights_.size() >= options_.jobs || started_ >= options_.most_flights) return {};
    if (refused_.count(id) != 0) continue;
    if (std::binary_search(taken_jobs->begin(), taken_jobs->end(), id)) continue;
    const Result<OpenJob> job = folder_.read_job(id);
    if (!job) {
      // Not found: it is over by now. Others may be readable at the next look.
      const bool is_over = job.error().code == ErrorCode::kNotFound;
      if (!is_over && unread_.insert(id).second && options_.warn) {
        options_.warn("flight " + id + ": " + job.error().message + "; tried again");
      }
      continue;
    }
    const std::string reason = refusal(*job);
    if (!reason.empty()) {
      refused_.insert(id);
      if (options_.warn) options_.warn("flight " + id + " is not flown here: " + reason);
      continue;
    }
    if (!has_memory(job->memory)) return {};
    const Result<bool> taken = folder_.take(id, state_.name);
    if (!taken) return taken.error();
    if (!*taken) continue;
    if (!folder_.is_open(id)) {  // The controller has taken it back in between.
      if (Status status = folder_.release(id); !status) return status;
      continue;
    }
    if (Status status = fly(*job); !status) return status;
  }
  return {};
}

Status JobWorker::fly(const OpenJob& job) {
  ++started_;
  note("flight " + job.id + " begins");
  Status started = processes_->start({job.id,
                                      folder_.scenario(job.flight),
                                      folder_.run(job.id),
                                      folder_.output(job.id),
                                      job.timeout_s,
                                      job.memory});
  if (started) {
    flights_.emplace(job.id, job.memory);
  } else {
    // The controller decides whether it is flown again.
    deliveries_.push_back({job.id, state_.name, 0.0, false, started.error().message});
  }
  return {};
}

Result<bool> JobWorker::step() {
  if (Status status = take_ended(); !status) return status.error();
  if (Clock::now() >= next_beat_) {
    if (Status status = tolerate(beat()); !status) return status.error();
    give_up_withdrawn();
  }
  if (Status status = tolerate(deliver()); !status) return status.error();
  if (Clock::now() >= next_look_) {
    next_look_ = Clock::now() + kLookPeriod;
    was_open_ = was_open_ || !folder_.is_closed();
    if (Status status = tolerate(take_jobs()); !status) return status.error();
  }
  const auto now = Clock::now();
  if (!flights_.empty() || !deliveries_.empty()) {
    busy_ = now;
    return true;
  }
  // A folder that was closed by an earlier call may be opened again by the next one.
  return started_ < options_.most_flights && !(was_open_ && folder_.is_closed()) &&
         now - busy_ <= seconds_of(options_.idle_s);
}

Status JobWorker::stop() {
  processes_->stop();
  for (const auto& [job, memory] : flights_) {
    // Not fatal: the controller removes them when the flight is given to another worker.
    (void)folder_.remove_flight(job);
  }
  flights_.clear();
  (void)deliver();  // What cannot be written is given back too.
  deliveries_.clear();
  state_.over = true;
  return beat();
}

}  // namespace overfly::server::experiments
