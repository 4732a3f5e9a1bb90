// The folder `jobs` of a sweep, through which flights reach workers on other machines of a shared
// file system, and their results come back.
//
// Two kinds of process use it: one controller, which holds the sweep's RunLock and is the only one
// that writes results, and any number of workers. No clocks are compared: a worker shows that it
// lives by changing its file, and the controller measures by its own clock how long it did not.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/flights/flight_executor.hpp"
#include "server/runs/run_memory.hpp"

namespace overfly::server::experiments {

/// A flight that workers may take. Each attempt of a flight is a job with an id of its own, so that
/// a late delivery of an earlier attempt is recognised.
struct OpenJob {
  std::string id;       ///< "000123-9f3a2c01"
  std::string flight;   ///< its scenario is scenarios/FLIGHT.json of the sweep
  std::string version;  ///< of the program that may fly it
  double timeout_s = 0.0;
  RunMemory memory;
};

/// What a worker says about itself.
struct WorkerState {
  std::string name;               ///< "host-1234-9f3a2c01"
  std::size_t beat = 0;           ///< grows while the worker lives
  bool over = false;              ///< it has ended, and gives back what it did not deliver
  std::vector<std::string> jobs;  ///< that it flies, or has flown and not delivered yet
};

/// A job that a worker has flown.
struct JobDelivery {
  std::string job;
  std::string worker;
  double duration_s = 0.0;
  bool timed_out = false;
  std::string reason;  ///< as EndedFlight::reason
};

class JobFolder {
 public:
  /// @param sweep  folder of the sweep
  explicit JobFolder(std::filesystem::path sweep)
      : sweep_(std::move(sweep)), folder_(sweep_ / "jobs") {}

  /// Creates the folders. Errors: kIo.
  [[nodiscard]] Status create() const;

  // The controller's part.

  /// Makes a flight available. Errors: kIo.
  [[nodiscard]] Status publish(const OpenJob& job) const;
  /// Takes a job back: no worker can take it any more, and one that flies it gives up. Files of an
  /// unfinished flight are removed as far as no worker writes them; that one removes the rest.
  /// Errors: kIo.
  [[nodiscard]] Status withdraw(const std::string& job) const;
  /// Removes what flights of other jobs have written, as far as that is possible.
  void remove_flights_except(const std::set<std::string>& jobs) const;
  /// Moves the run folder and the output of a delivered job to where the flight's belong.
  /// Errors: kIo.
  [[nodiscard]] Status move_flight(const std::string& job, const FlightJob& to) const;
  /// Ids of jobs for which a delivery was written, in order. Errors: kIo.
  [[nodiscard]] Result<std::vector<std::string>> delivered() const;
  [[nodiscard]] bool is_delivered(const std::string& job) const;
  /// Errors: as read_json; kUnreadable.
  [[nodiscard]] Result<JobDelivery> read_delivery(const std::string& job) const;
  [[nodiscard]] Status remove_delivery(const std::string& job) const;
  /// Ids of jobs that a worker has taken, in order. Errors: kIo.
  [[nodiscard]] Result<std::vector<std::string>> taken() const;
  /// The worker that has taken a job; empty if none has.
  /// Errors: as read_json but kNotFound; kUnreadable.
  [[nodiscard]] Result<std::optional<std::string>> holder(const std::string& job) const;
  /// Empty if the worker's file is missing or invalid.
  [[nodiscard]] std::optional<WorkerState> worker(const std::string& name) const;
  /// Removes the files of workers that are not in `names`; one that lives writes its file again.
  /// Errors: kIo.
  [[nodiscard]] Status remove_workers_except(const std::set<std::string>& names) const;
  /// Tells workers that no flight will follow, or that more will. Errors: kIo.
  [[nodiscard]] Status set_closed(bool closed) const;

  // The workers' part.

  /// Ids of jobs that are not over, in the order of publication. Errors: kIo.
  [[nodiscard]] Result<std::vector<std::string>> open_jobs() const;
  /// Errors: as read_json; kUnreadable naming file and field.
  [[nodiscard]] Result<OpenJob> read_job(const std::string& job) const;
  [[nodiscard]] bool is_open(const std::string& job) const;
  /// Leaves a job to others. @pre this worker has taken it
  /// Errors: kIo.
  [[nodiscard]] Status release(const std::string& job) const;
  /// Removes what a job in flight has written. Errors: kIo.
  [[nodiscard]] Status remove_flight(const std::string& job) const;
  /// False if another worker was faster. Safe on NFS: link(2) either creates the name or fails.
  /// Errors: kIo.
  [[nodiscard]] Result<bool> take(const std::string& job, const std::string& worker) const;
  /// Errors: kIo.
  [[nodiscard]] Status show_worker(const WorkerState& state) const;
  /// Errors: kIo.
  [[nodiscard]] Status deliver(const JobDelivery& delivery) const;
  [[nodiscard]] bool is_closed() const;

  [[nodiscard]] std::filesystem::path scenario(const std::string& flight) const;
  /// The run folder of a job in flight.
  [[nodiscard]] std::filesystem::path run(const std::string& job) const;
  [[nodiscard]] std::filesystem::path output(const std::string& job) const;
  /// For what a scheduler needs: the folder `jobs/NAME`.
  [[nodiscard]] std::filesystem::path part(const std::string& name) const { return folder_ / name; }

 private:
  [[nodiscard]] std::filesystem::path file(const char* kind,
                                           const std::string& name,
                                           const char* extension = ".json") const;

  std::filesystem::path sweep_;
  std::filesystem::path folder_;
};

/// Eight random hexadecimal digits, for names that must differ.
[[nodiscard]] std::string random_name();

}  // namespace overfly::server::experiments
