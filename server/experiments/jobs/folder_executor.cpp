#include "server/experiments/jobs/folder_executor.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/text/number_text.hpp"

namespace overfly::server::experiments {
namespace {

/// Attempts in a row that may be lost: a flight that ends its worker each time (by its memory) must
/// not be flown for ever.
constexpr int kMostLost = 5;
/// Ids have six hexadecimal digits for the number.
constexpr std::size_t kMostNumbers = 0x1000000;

std::string job_id(std::size_t number) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%06zx", number % kMostNumbers);
  return std::string(text.data()) + "-" + random_name();
}

}  // namespace

Result<std::unique_ptr<FolderExecutor>> FolderExecutor::open(const std::filesystem::path& sweep,
                                                             FolderExecutorOptions options) {
  std::unique_ptr<FolderExecutor> executor(new FolderExecutor(sweep, std::move(options)));
  if (Status status = executor->folder_.create(); !status) return status.error();
  if (Status status = executor->folder_.set_closed(false); !status) return status.error();
  if (Status status = executor->take_over(); !status) return status.error();
  return executor;
}

Status FolderExecutor::take_over() {
  const Result<std::vector<std::string>> open = folder_.open_jobs();
  if (!open) return open.error();
  for (const std::string& id : *open) {
    next_number_ = std::max<std::size_t>(next_number_, std::stoul(id, nullptr, 16) + 1);
    const Result<OpenJob> job = folder_.read_job(id);
    const bool usable = job && job->version == options_.version;
    if (usable && left_.emplace(job->flight, id).second) continue;
    if (Status status = folder_.withdraw(id); !status) return status;
  }
  std::set<std::string> ids;
  std::set<std::string> holders;
  for (const auto& [flight, id] : left_) {
    ids.insert(id);
    const Result<std::optional<std::string>> holder = folder_.holder(id);
    if (holder && *holder) holders.insert(**holder);
  }
  folder_.remove_flights_except(ids);
  return folder_.remove_workers_except(holders);
}

Status FolderExecutor::start(const FlightJob& flight) {
  most_memory_.images_bytes = std::max(most_memory_.images_bytes, flight.memory.images_bytes);
  most_memory_.caches_bytes = std::max(most_memory_.caches_bytes, flight.memory.caches_bytes);
  Job job;
  job.flight = flight;
  const auto left = left_.find(flight.id);
  if (left == left_.end()) return publish(std::move(job));
  jobs_.emplace(left->second, std::move(job));
  left_.erase(left);
  return {};
}

Status FolderExecutor::publish(Job job) {
  const std::string id = job_id(next_number_++);
  const FlightJob& flight = job.flight;
  Status status =
      folder_.publish({id, flight.id, options_.version, flight.timeout_s, flight.memory});
  if (status) jobs_.emplace(id, std::move(job));
  return status;
}

Result<std::optional<EndedFlight>> FolderExecutor::ended() {
  if (ended_.empty() && Clock::now() >= next_poll_) {
    if (Status status = poll(); !status) return status.error();
    next_poll_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                    std::chrono::duration<double>(options_.poll_s));
  }
  if (ended_.empty()) return std::optional<EndedFlight>();
  std::optional<EndedFlight> flight(std::move(ended_.front()));
  ended_.pop_front();
  return flight;
}

Status FolderExecutor::poll() {
  // What an earlier controller left and this one has not asked for is not due any more.
  for (const auto& [flight, id] : left_) {
    if (Status status = folder_.withdraw(id); !status) return status;
  }
  left_.clear();
  if (Status status = take_delivered(); !status) return status;
  if (Status status = find_lost(); !status) return status;
  if (Status status = check_waiting(); !status) return status;
  if (options_.supply == nullptr) return {};
  return options_.supply->keep({jobs_.size(), jobs_.size() - flying_, delivered_}, most_memory_);
}

Status FolderExecutor::take_delivered() {
  const Result<std::vector<std::string>> delivered = folder_.delivered();
  if (!delivered) return delivered.error();
  for (const std::string& id : *delivered) {
    const auto job = jobs_.find(id);
    const Result<JobDelivery> delivery = folder_.read_delivery(id);
    if (job != jobs_.end() && delivery) {
      const FlightJob& flight = job->second.flight;
      if (Status status = folder_.move_flight(id, flight); !status) return status;
      ended_.push_back({flight.id, delivery->duration_s, delivery->timed_out, delivery->reason});
      jobs_.erase(job);
      ++delivered_;
    } else if (job != jobs_.end()) {
      if (Status status = lose(id, delivery.error().message, false); !status) return status;
    }
    // Also an attempt that was given up: another one has been published for it.
    if (Status status = folder_.withdraw(id); !status) return status;
    if (Status status = folder_.remove_delivery(id); !status) return status;
  }
  return {};
}

bool FolderExecutor::is_over(Clock::time_point since) const {
  return std::chrono::duration<double>(Clock::now() - since).count() > options_.lease_s;
}

std::string FolderExecutor::loss(const std::string& id, Job& job, bool& given_back) {
  if (!job.holder) {
    // A file that cannot be read now, or is damaged: then the job is lost after the same time.
    const Result<std::optional<std::string>> holder = folder_.holder(id);
    if (holder) job.holder = *holder;
  }
  const std::string worker = job.holder.value_or(id);
  const std::optional<WorkerState> state = folder_.worker(worker);
  const auto now = Clock::now();
  const std::size_t beat = state ? state->beat : 0;
  const auto [known, is_new] = workers_.emplace(worker, Worker{beat, now});
  if (!is_new && known->second.beat != beat) known->second = {beat, now};
  given_back = state && state->over;
  if (given_back) return "worker " + worker + " has ended";
  if (is_over(known->second.changed)) {
    return "worker " + worker + " has not been heard of for " + number_text(options_.lease_s) +
           " s";
  }
  const bool named =
      !state || std::find(state->jobs.begin(), state->jobs.end(), id) != state->jobs.end();
  if (named) {
    job.dropped.reset();
  } else if (!job.dropped) {
    job.dropped = now;
  }
  if (!job.dropped || !is_over(*job.dropped)) return "";
  return "worker " + worker + " flies, but no longer this flight";
}

Status FolderExecutor::find_lost() {
  const Result<std::vector<std::string>> open = folder_.open_jobs();
  if (!open) return open.error();
  const Result<std::vector<std::string>> taken = folder_.taken();
  if (!taken) return taken.error();
  flying_ = 0;
  std::vector<std::pair<std::string, std::string>> lost;  // id, reason
  std::set<std::string> given_back_ids;
  std::set<std::string> holders;
  for (auto& [id, job] : jobs_) {
    std::string reason;
    bool given_back = false;
    const bool is_taken = std::binary_search(taken->begin(), taken->end(), id);
    if (!std::binary_search(open->begin(), open->end(), id)) {
      reason = "job " + id + " was removed from outside";
    } else if (is_taken) {
      reason = loss(id, job, given_back);
      holders.insert(job.holder.value_or(id));
    }
    // A worker may have delivered it, and ended, after the deliveries were read.
    if (reason.empty() || folder_.is_delivered(id)) {
      if (is_taken) ++flying_;
      continue;
    }
    lost.emplace_back(id, reason);
    if (given_back) given_back_ids.insert(id);
  }
  std::erase_if(workers_, [&](const auto& worker) { return holders.count(worker.first) == 0; });
  for (const auto& [id, reason] : lost) {
    if (Status status = lose(id, reason, given_back_ids.count(id) != 0); !status) return status;
  }
  return withdraw_unknown(*taken);
}

Status FolderExecutor::check_waiting() {
  const Result<std::vector<std::string>> taken = folder_.taken();
  if (!taken) return taken.error();
  const auto waits = [&](const auto& job) {
    return !std::binary_search(taken->begin(), taken->end(), job.first);
  };
  auto next = std::find_if(jobs_.upper_bound(checked_), jobs_.end(), waits);
  if (next == jobs_.end()) next = std::find_if(jobs_.begin(), jobs_.end(), waits);
  if (next == jobs_.end()) return {};
  checked_ = next->first;
  const Result<OpenJob> job = folder_.read_job(checked_);
  // One that is not there was delivered meanwhile or is found by the next look.
  if (job || job.error().code == ErrorCode::kNotFound) return {};
  return lose(checked_, job.error().message, false);
}

Status FolderExecutor::lose(const std::string& id, const std::string& reason, bool given_back) {
  if (Status status = folder_.withdraw(id); !status) return status;
  const auto found = jobs_.find(id);
  Job job = std::move(found->second);
  jobs_.erase(found);
  if (!given_back && ++job.lost > kMostLost) {
    ended_.push_back(
        {job.flight.id,
         0.0,
         false,
         std::to_string(job.lost) + " attempts to fly it were lost; the last: " + reason});
    return {};
  }
  if (options_.warn) options_.warn(reason + "; its flight is flown again");
  job.holder.reset();
  job.dropped.reset();
  return publish(std::move(job));
}

Status FolderExecutor::withdraw_unknown(const std::vector<std::string>& taken) {
  for (const std::string& id : taken) {
    if (jobs_.count(id) != 0) continue;
    if (Status status = folder_.withdraw(id); !status) return status;
  }
  return {};
}

void FolderExecutor::stop() {
  const auto report = [this](const Status& status) {
    if (!status && options_.warn) options_.warn(status.error().message);
  };
  report(folder_.set_closed(true));
  for (const auto& [id, job] : jobs_) report(folder_.withdraw(id));
  for (const auto& [flight, id] : left_) report(folder_.withdraw(id));
  jobs_.clear();
  left_.clear();
  ended_.clear();
  if (options_.supply != nullptr) options_.supply->stop();
}

}  // namespace overfly::server::experiments
