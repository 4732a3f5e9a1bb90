// Flies sweeps for the clients of a server, one at a time.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/envelope/envelope.hpp"
#include "server/experiments/service/client_sweep.hpp"
#include "server/experiments/service/sweep_cost.hpp"
#include "server/runs/run_manager.hpp"

namespace overfly::server::experiments {

struct SweepServiceOptions {
  std::filesystem::path program = "/proc/self/exe";  ///< flies single scenarios
  /// Size of the frame cache that all sweeps share, in their folder; 0 = none.
  double frame_cache_gib = 0.0;
  std::function<void()> begin_thread;  ///< called on the thread that flies
  std::function<void(const std::string& level, const std::string& text)> log;
};

/// What a client asks for.
struct SweepRequest {
  nlohmann::json document;
  std::size_t jobs = 0;  ///< flights at the same time; 0: default_jobs()
  /// Only the cells that this needs are flown; empty: all cells.
  std::optional<BorderSearch> border = std::nullopt;
};

/// Thread-safe. The flights are processes, which end with this one. They share the memory of the
/// server with its runs, and have the priority of the thread that flies.
class SweepService {
 public:
  /// @param runs  must outlive the object
  SweepService(RunManager& runs, SweepServiceOptions options);
  ~SweepService() { stop(); }
  SweepService(const SweepService&) = delete;
  SweepService& operator=(const SweepService&) = delete;

  /// Half of the processors.
  [[nodiscard]] static std::size_t default_jobs();
  [[nodiscard]] static std::size_t most_jobs();

  /// Folder of the sweep files that clients may fly.
  [[nodiscard]] std::filesystem::path files_folder() const;
  /// As sweep_list. Each entry has "here" too: "flying" or "cancelling" if this server flies it,
  /// else null; and "problem": why its last flight here ended early, else null.
  /// "envelope" is {"axis","estimator","found"} if only the border along an axis was sought, else
  /// null.
  [[nodiscard]] nlohmann::json list() const;
  /// One such entry. Errors: as sweep_entry.
  [[nodiscard]] Result<nlohmann::json> entry(const std::string& name) const;
  /// As json_from(Envelope), its `lines` null until it is found; null if every cell is flown, for a
  /// file that cannot be read, and if the sweep has other cells since.
  /// @param entry  of a sweep
  [[nodiscard]] nlohmann::json envelope(const nlohmann::json& entry) const;
  /// The document of a sweep. Errors: kNotFound; as read_sweep_document.
  [[nodiscard]] Result<nlohmann::json> document(const std::string& name) const;

  /// What a sweep costs. Errors: as read_client_sweep.
  [[nodiscard]] Result<SweepCost> check(const nlohmann::json& document,
                                        SweepRefusal& refusal,
                                        const std::atomic<bool>* cancel) const;
  /// Flies a new sweep.
  /// Errors: kInvalidArgument for the name; as check_border; kConflict if it exists, or with
  /// `refusal`; as check().
  [[nodiscard]] Status start(const std::string& name,
                             const SweepRequest& request,
                             SweepRefusal& refusal,
                             const std::atomic<bool>* cancel);
  /// Flies what a sweep lacks. A null document stands for the sweep's own.
  /// Errors: kNotFound; kConflict while a process works on it, or with `refusal`; as check() and
  /// check_border.
  [[nodiscard]] Status go_on(const std::string& name,
                             const SweepRequest& request,
                             SweepRefusal& refusal,
                             const std::atomic<bool>* cancel);
  /// Ends the flights in progress; the results stay.
  /// Errors: kNotFound; kConflict if this server does not fly it.
  [[nodiscard]] Status cancel(const std::string& name);
  /// Deletes a sweep with the runs of its flights. Its name is free at once; its files go later, on
  /// a thread of their own. Of a symbolic link only the link is deleted.
  /// Errors: kNotFound; kConflict while it is flown, also by another process; kIo.
  [[nodiscard]] Status remove(const std::string& name);
  /// Cancels the sweep in progress and refuses further ones.
  void request_stop();
  /// The same, and waits for its end.
  void stop();

 private:
  struct Flight {
    std::string name;
    ClientSweep sweep;
    std::size_t jobs = 1;
    std::optional<BorderSearch> border;
    std::atomic<bool> cancel{false};
    bool over = false;  ///< guarded by the service
  };
  [[nodiscard]] Status check_free(SweepRefusal& refusal) const;
  /// @pre the folder exists
  [[nodiscard]] Status launch(const std::string& name,
                              ClientSweep sweep,
                              const SweepRequest& request);
  void fly(Flight& flight);
  /// Errors: as fly_sweep; kIo.
  [[nodiscard]] Status fly_into(const Flight& flight, const std::filesystem::path& folder);
  void log(const char* level, const std::string& name, const std::string& text) const;
  void add_state(nlohmann::json& entry) const;
  void delete_later(const std::filesystem::path& folder);

  // @pre for those below: mutex_ is held
  [[nodiscard]] bool is_busy() const { return flight_ && !flight_->over; }

  RunManager& runs_;
  const SweepServiceOptions options_;
  const std::filesystem::path folder_;
  std::mutex launching_;  ///< held while a sweep is being started or continued
  mutable std::mutex mutex_;
  bool stopping_ = false;
  std::shared_ptr<Flight> flight_;               ///< the last one
  std::map<std::string, std::string> problems_;  ///< by sweep
  std::thread thread_;
  std::vector<std::future<void>> deletions_;  ///< in progress; guarded by mutex_
};

}  // namespace overfly::server::experiments
