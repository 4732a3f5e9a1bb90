// Workers as tasks of Slurm job arrays, by its commands sbatch, squeue and scancel.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/jobs/worker_supply.hpp"

namespace overfly::server::experiments {

struct SlurmOptions {
  std::filesystem::path sweep;    ///< folder of the sweep, absolute, on a shared file system
  std::filesystem::path program;  ///< this program, by the same path on all nodes
  std::size_t workers = 64;       ///< tasks at the same time at most
  std::vector<std::string> submit_options;  ///< further ones of sbatch, after ours
  std::vector<std::string> worker_options;  ///< further ones of `overfly sweep work`
  double period_s = 5.0;                    ///< how often the queue is asked
  double patience_s = 60.0;                 ///< longest time between two attempts to submit
  std::function<void(const std::string&)> warn;
};

/// Keeps as many tasks queued or running as there are flights, up to SlurmOptions::workers. Nothing
/// is submitted for flights that a worker has taken: if it was killed, they are free again after
/// its lease. The queue is only asked which tasks there are: what was flown is known from the job
/// folder alone, so that a queue that does not answer, or a task that Slurm loses, costs no flight.
/// Tasks that Slurm holds because it could not launch them are replaced; for what others wait is
/// reported. All tasks have a name that only this sweep uses, by which they are found after the
/// controller was restarted.
class SlurmWorkers : public WorkerSupply {
 public:
  /// Errors: kNotFound if sbatch is missing; kUnreadable if the name of an earlier call is damaged;
  /// kIo.
  [[nodiscard]] static Result<std::unique_ptr<SlurmWorkers>> open(SlurmOptions options);

  /// Errors: kUnsupported if Slurm refuses the first tasks three times, or if tasks end again and
  /// again without a flight.
  Status keep(const FlightCounts& flights, const RunMemory& memory) override;
  void stop() override;

 private:
  using Clock = std::chrono::steady_clock;

  explicit SlurmWorkers(SlurmOptions options) : options_(std::move(options)) {}
  Status load_name();
  Status write_script() const;
  /// Tasks that run or will; empty if the queue does not answer.
  std::optional<std::size_t> tasks();
  /// @param tasks  held by Slurm
  void cancel_held(const std::vector<std::string>& tasks);
  /// @param reason  why all tasks wait; empty if one runs, or if they wait for their turn
  void report_waiting(const std::string& reason);
  Status submit(std::size_t tasks, const RunMemory& memory);
  Status refused(const std::string& reason);
  /// Seconds before the next attempt after `failures_` in a row.
  [[nodiscard]] double pause_s() const;

  SlurmOptions options_;
  std::string name_;  ///< of all jobs of this sweep: "overfly-9f3a2c01"
  Clock::time_point next_question_;
  Clock::time_point next_submission_;
  std::string waiting_;     ///< the reason that was reported last
  bool silent_ = false;     ///< the queue does not answer, which was reported
  bool submitted_ = false;  ///< at least once
  int failures_ = 0;        ///< of submissions, in a row
  int fruitless_ = 0;       ///< submissions in a row, whose tasks ended without taking a flight
  std::size_t delivered_at_submission_ = 0;
};

}  // namespace overfly::server::experiments
