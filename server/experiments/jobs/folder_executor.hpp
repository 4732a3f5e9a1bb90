// The controller of a job folder: flights are flown by workers, wherever these run.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/flights/flight_executor.hpp"
#include "server/experiments/jobs/job_folder.hpp"
#include "server/experiments/jobs/worker_supply.hpp"

namespace overfly::server::experiments {

struct FolderExecutorOptions {
  std::string version;  ///< of the program that may fly the jobs
  /// A worker that has not shown for so long that it lives loses its flights. Above the time for
  /// which clients of a network file system may see old files (60 s with NFS).
  double lease_s = 180.0;
  double poll_s = 0.5;                   ///< how often the folder is read
  std::unique_ptr<WorkerSupply> supply;  ///< null: workers are started by somebody else
  std::function<void(const std::string&)> warn;
};

/// Flights as jobs of a folder. A job whose worker ends without delivering it (killed, preempted,
/// its machine lost) is published again, up to five times in a row unless the worker gave it back.
/// Jobs that a killed controller left are taken over with the flights in progress.
/// @pre the caller holds the sweep's RunLock as long as the executor lives
class FolderExecutor : public FlightExecutor {
 public:
  /// Errors: kIo.
  [[nodiscard]] static Result<std::unique_ptr<FolderExecutor>> open(
      const std::filesystem::path& sweep, FolderExecutorOptions options);

  Status start(const FlightJob& job) override;
  [[nodiscard]] std::size_t running() const override { return jobs_.size() + ended_.size(); }
  [[nodiscard]] std::size_t flying() const override { return flying_; }
  /// Errors: kIo; as WorkerSupply::keep.
  [[nodiscard]] Result<std::optional<EndedFlight>> ended() override;
  void stop() override;

 private:
  using Clock = std::chrono::steady_clock;

  struct Job {
    FlightJob flight;
    int lost = 0;                              ///< attempts without a delivery
    std::optional<std::string> holder;         ///< the worker that has taken it
    std::optional<Clock::time_point> dropped;  ///< since when the worker does not name it
  };
  struct Worker {
    std::size_t beat = 0;
    Clock::time_point changed;
  };

  FolderExecutor(const std::filesystem::path& sweep, FolderExecutorOptions options)
      : folder_(sweep), options_(std::move(options)) {}
  Status take_over();
  Status publish(Job job);
  Status poll();
  Status take_delivered();
  Status find_lost();
  /// Reads the file of one job that no worker has taken, each time the next one: workers wait for
  /// a file that they cannot read.
  Status check_waiting();
  Status withdraw_unknown(const std::vector<std::string>& taken);
  /// Why a worker will not deliver a job that it has taken; empty as long as it may.
  /// @param given_back  set if the worker ended in order
  [[nodiscard]] std::string loss(const std::string& id, Job& job, bool& given_back);
  Status lose(const std::string& id, const std::string& reason, bool given_back);
  [[nodiscard]] bool is_over(Clock::time_point since) const;

  JobFolder folder_;
  FolderExecutorOptions options_;
  std::map<std::string, Job> jobs_;          ///< by id
  std::map<std::string, std::string> left_;  ///< jobs of an earlier controller: flight -> id
  std::map<std::string, Worker> workers_;    ///< that hold a job, by name
  std::string checked_;                      ///< id of the job whose file was read last
  std::deque<EndedFlight> ended_;
  RunMemory most_memory_;
  std::size_t next_number_ = 0;
  std::size_t flying_ = 0;
  std::size_t delivered_ = 0;
  Clock::time_point next_poll_;
};

}  // namespace overfly::server::experiments
