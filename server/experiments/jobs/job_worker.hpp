// A worker: takes jobs of a sweep's job folder, flies them on this machine and delivers them.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/flights/flight_process.hpp"
#include "server/experiments/jobs/job_folder.hpp"
#include "server/experiments/pictures/flight_frame_cache.hpp"
#include "server/runs/run_memory.hpp"

namespace overfly::server::experiments {

struct WorkerOptions {
  std::filesystem::path sweep;    ///< folder of the sweep
  std::filesystem::path program;  ///< this program, which flies single scenarios
  std::string version;            ///< of this program: jobs of another one are not taken
  std::size_t jobs = 1;           ///< flights at the same time, if the memory suffices
  std::size_t most_flights = std::numeric_limits<std::size_t>::max();
  /// Rendered pictures on this machine. The worker does not know whether another flight will need
  /// its pictures, and keeps all.
  FlightFrameCache frame_cache;
  double idle_s = 60.0;   ///< without a job the worker waits so long for the next one
  double beat_s = 5.0;    ///< how often it shows that it lives
  double silence_s = 60;  ///< it gives up if its folder cannot be written for so long
  std::function<void(const std::string&)> note;  ///< what it does
  std::function<void(const std::string&)> warn;
};

class JobWorker {
 public:
  /// Errors: kNotFound if the folder is no sweep; kIo.
  [[nodiscard]] static Result<JobWorker> start(WorkerOptions options);

  /// Does what is due, without waiting. False when the worker's work is over.
  /// Errors: kIo if its folder could not be written for too long.
  [[nodiscard]] Result<bool> step();
  /// Ends flights in progress and gives them back. Errors: kIo.
  Status stop();

  [[nodiscard]] std::size_t flown() const { return flown_; }
  [[nodiscard]] std::size_t flying() const { return flights_.size(); }

 private:
  using Clock = std::chrono::steady_clock;

  explicit JobWorker(WorkerOptions options);
  /// Shows that the worker lives and gives up flights that the controller has taken back.
  Status beat();
  void give_up_withdrawn();
  /// True if the controller has taken a job back; false also if that cannot be found out now.
  [[nodiscard]] bool is_withdrawn(const std::string& job) const;
  Status take_ended();
  Status deliver();
  Status take_jobs();
  /// Why a job cannot be flown by this worker at all; empty if it can.
  [[nodiscard]] std::string refusal(const OpenJob& job) const;
  [[nodiscard]] bool has_memory(RunMemory memory) const;
  Status fly(const OpenJob& job);
  void note(const std::string& text) const;
  void has_written();
  /// @return the status, or ok as long as writing has not failed for too long
  Status tolerate(const Status& status);

  WorkerOptions options_;
  JobFolder folder_;
  MemoryBudget budget_;
  std::unique_ptr<FlightProcesses> processes_;
  WorkerState state_;
  std::map<std::string, RunMemory> flights_;  ///< in the air, by job
  std::vector<JobDelivery> deliveries_;       ///< flown, not written yet
  std::set<std::string> refused_;             ///< jobs that are not for this machine
  std::set<std::string> unread_;              ///< jobs whose files were reported
  std::size_t started_ = 0;
  std::size_t flown_ = 0;  ///< delivered
  bool was_open_ = false;  ///< the folder, since this worker started
  Clock::time_point next_beat_;
  Clock::time_point next_look_;
  Clock::time_point busy_;     ///< the last time that there was a flight
  Clock::time_point written_;  ///< the last time that writing worked
  bool complained_ = false;    ///< about writing
};

}  // namespace overfly::server::experiments
