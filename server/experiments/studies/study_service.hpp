// Makes studies for the clients of a server: one at a time, the others wait.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "core/result.hpp"
#include "server/experiments/studies/study_record.hpp"
#include "server/runs/run_manager.hpp"

namespace overfly::server::experiments {

struct StudyServiceOptions {
  std::filesystem::path program = "/proc/self/exe";  ///< makes the studies
  std::function<void()> begin_thread;                ///< called on the thread that starts it
  std::function<void(const std::string& level, const std::string& text)> log;
};

/// Thread-safe. A study is made by a process, `overfly explain`, `predict` or `hunt`, which ends
/// with this one, and so do its flights. It shares the memory of the server with its runs, and has
/// the priority of the thread that starts it.
class StudyService {
 public:
  static constexpr std::size_t kMostWaiting = 20;
  static constexpr std::size_t kMostKept = 1000;

  /// @param runs  must outlive the object
  StudyService(RunManager& runs, StudyServiceOptions options);
  ~StudyService() { stop(); }
  StudyService(const StudyService&) = delete;
  StudyService& operator=(const StudyService&) = delete;

  /// Half of the processors.
  [[nodiscard]] static std::size_t default_jobs();
  [[nodiscard]] static std::size_t most_jobs();

  /// {"studies": [...]}, the newest first: an entry of each, as entry().
  [[nodiscard]] nlohmann::json list() const;
  /// {"name", "kind", "title", "subject", "estimator", "created_utc", "ended_utc", "state",
  /// "cancelling", "position", "problem", "progress"}: `position` is that in the queue, 1 = next;
  /// `progress` is {"share", "text", "spent_s", "left_s"} while it is made.
  /// Errors: kNotFound, also for a name that is not plain; as StudyFolder::read.
  [[nodiscard]] Result<nlohmann::json> entry(const std::string& name) const;
  /// What it has found, as study_result. Errors: as entry and study_result.
  [[nodiscard]] Result<nlohmann::json> result(const std::string& name) const;
  /// Errors: as entry, study_page.
  [[nodiscard]] Result<std::string> page(const std::string& name) const;
  /// Errors: as entry, worst_scenario.
  [[nodiscard]] Result<nlohmann::json> worst(const std::string& name) const;

  /// Checks a study and lets it wait for its turn. @return its name
  /// Errors: kConflict with `refusal`, or when the server stops; as prepare_study; kIo.
  [[nodiscard]] Result<std::string> start(const StudyRequest& request,
                                          StudyRefusal& refusal,
                                          const std::atomic<bool>* cancel);
  /// Lets a study that has ended be made again: flights that were completed are not flown twice.
  /// Errors: kConflict for one that has not ended, or with `refusal`; as entry, check_again.
  [[nodiscard]] Status go_on(const std::string& name, StudyRefusal& refusal);
  /// Ends its process; what it has found stays.
  /// Errors: as entry; kConflict if it has ended.
  [[nodiscard]] Status cancel(const std::string& name);
  /// Deletes its folder with the runs of its flights.
  /// Errors: as entry; kConflict while it waits or is made; kIo.
  [[nodiscard]] Status remove(const std::string& name);
  /// Asks the study in progress to end, and refuses further ones.
  void request_stop();
  /// The same, and waits for its end.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  /// A study that waits or is made; the first of them is the one that is made.
  struct Active {
    std::string name;
    StudyRecord record;
    std::atomic<bool> cancel{false};
    std::atomic<bool> started{false};
    std::atomic<bool> over{false};
    // Guarded by the service:
    Clock::time_point begun;
    std::optional<double> first_share;  ///< of the first progress: what was done before
  };

  [[nodiscard]] Result<StudyFolder> folder_of(const std::string& name) const;
  [[nodiscard]] Status check_room(StudyRefusal& refusal) const;
  /// Errors: kConflict when the server stops; kInternal without a thread.
  [[nodiscard]] Status enqueue(const std::string& name, StudyRecord record);
  void work();
  void make(Active& study);
  [[nodiscard]] StudyEnd run_process(Active& study, const StudyFolder& folder);
  [[nodiscard]] std::shared_ptr<const void> wait_for_memory(const Active& study) const;
  [[nodiscard]] StudyEnd end_by_process(const Active& study,
                                        const StudyFolder& folder,
                                        int status) const;
  [[nodiscard]] bool must_end(const Active& study) const { return stopping_ || study.cancel; }
  void log(const char* level, const std::string& name, const std::string& text) const;
  [[nodiscard]] nlohmann::json entry_of(const std::string& name, const StudyRecord& record) const;

  // @pre for those below: mutex_ is held
  [[nodiscard]] std::shared_ptr<Active> active(const std::string& name) const;
  [[nodiscard]] nlohmann::json progress_of(Active& study) const;

  RunManager& runs_;
  const StudyServiceOptions options_;
  const std::filesystem::path folder_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::atomic<bool> stopping_{false};
  std::list<std::shared_ptr<Active>> queue_;
  std::thread thread_;
};

}  // namespace overfly::server::experiments
