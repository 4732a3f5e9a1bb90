#include "server/experiments/service/sweep_service.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "core/barrier.hpp"
#include "server/experiments/fly_sweep.hpp"
#include "server/experiments/service/sweep_files.hpp"
#include "server/experiments/sweep_folders.hpp"
#include "server/experiments/sweep_summary.hpp"
#include "server/files/plain_name.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_lock.hpp"
#include "server/runs/run_removal.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// No sweep of a client can have this name.
constexpr const char* kSharedFrameCache = ".frame_cache";

Status write_summary(const Sweep& sweep, const FlownSweep& flown, const fs::path& folder) {
  constexpr auto kMode = evaluation::AlignmentMode::kInitScale;
  const std::string table = markdown_from(sweep, summary_of(flown, folder, kMode), kMode);
  return write_whole(folder / "summary.md", table);
}

/// The border that is sought or was found, as json_from(Envelope). Null if every cell is flown, for
/// a file that cannot be read, and if the sweep has other cells since.
/// @param entry  of the sweep
Json envelope_of(const fs::path& folder, const Json& entry) {
  Result<Json> envelope = read_envelope(folder);
  if (!envelope) return nullptr;
  std::size_t cells = 1;
  bool has_axis = false;
  for (const Json& axis : entry.at("axes")) {
    cells *= axis.at("values").size();
    has_axis = has_axis || axis.at("name") == (*envelope)["axis"];
  }
  const bool found = !(*envelope)["lines"].is_null();
  if (!has_axis || (found && (*envelope)["cells"] != cells)) return nullptr;
  return std::move(*envelope);
}

}  // namespace

SweepService::SweepService(RunManager& runs, SweepServiceOptions options)
    : runs_(runs), options_(std::move(options)), folder_(runs.sweeps_folder()) {
  if (!folder_.empty()) remove_leftovers(folder_);
}

std::size_t SweepService::most_jobs() {
  return std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

std::size_t SweepService::default_jobs() { return std::max<std::size_t>(1, most_jobs() / 2); }

fs::path SweepService::files_folder() const { return sweep_files_folder(runs_.library().folder()); }

void SweepService::add_state(Json& entry) const {
  const Json envelope = this->envelope(entry);
  entry["envelope"] = envelope.is_null() ? Json()
                                         : Json{{"axis", envelope.at("axis")},
                                                {"estimator", envelope.at("estimator")},
                                                {"found", !envelope.at("lines").is_null()}};
  const std::lock_guard lock(mutex_);
  const auto& name = entry.at("name").get_ref<const std::string&>();
  entry["here"] = nullptr;
  if (is_busy() && flight_->name == name) {
    entry["here"] = flight_->cancel ? "cancelling" : "flying";
    entry["flying"] = true;
  }
  const auto problem = problems_.find(name);
  entry["problem"] = problem == problems_.end() ? Json() : Json(problem->second);
}

Json SweepService::list() const {
  Json list = sweep_list(folder_);
  for (Json& entry : list.at("sweeps")) add_state(entry);
  return list;
}

Result<Json> SweepService::entry(const std::string& name) const {
  Result<Json> entry = sweep_entry(folder_, name);
  if (entry) add_state(*entry);
  return entry;
}

Json SweepService::envelope(const Json& entry) const {
  return envelope_of(folder_ / entry.at("name").get_ref<const std::string&>(), entry);
}

Result<Json> SweepService::document(const std::string& name) const {
  const Result<Json> known = sweep_entry(folder_, name);
  if (!known) return known.error();
  return read_sweep_document(folder_ / name);
}

Result<SweepCost> SweepService::check(const Json& document,
                                      SweepRefusal& refusal,
                                      const std::atomic<bool>* cancel) const {
  const Result<ClientSweep> read = read_client_sweep(runs_, document, refusal, cancel);
  if (!read) return read.error();
  return sweep_cost(*read->sweep, read->plan, folder_);
}

Status SweepService::check_free(SweepRefusal& refusal) const {
  if (folder_.empty()) {
    refusal = SweepRefusal::kOff;
    return Error{ErrorCode::kConflict, "this server has no folder of sweeps"};
  }
  const std::lock_guard lock(mutex_);
  if (stopping_) return Error{ErrorCode::kConflict, "the server is stopping"};
  if (!is_busy()) return {};
  refusal = SweepRefusal::kBusy;
  return Error{ErrorCode::kConflict,
               "sweep \"" + flight_->name +
                   "\" is flying: one sweep flies at a time; cancel it or wait for its end"};
}

Status SweepService::start(const std::string& name,
                           const SweepRequest& request,
                           SweepRefusal& refusal,
                           const std::atomic<bool>* cancel) {
  if (!is_given_name(name)) {
    return Error{ErrorCode::kInvalidArgument,
                 "name = " + name.substr(0, 100) + ": " + kGivenNameRule};
  }
  const Error exists{ErrorCode::kConflict,
                     "sweep \"" + name + "\" exists: continue it, or choose another name"};
  std::error_code failed;
  const bool taken = fs::exists(fs::symlink_status(folder_ / name, failed));
  const std::unique_lock launching(launching_, std::try_to_lock);
  if (Status free = check_free(refusal); !free) return free;
  if (!launching) {
    refusal = SweepRefusal::kBusy;
    return Error{ErrorCode::kConflict, "another sweep is being started: try again soon"};
  }
  if (taken) return exists;
  Result<ClientSweep> read = read_client_sweep(runs_, request.document, refusal, cancel);
  if (!read) return read.error();
  fs::create_directories(folder_, failed);
  const bool made = !failed && fs::create_directory(folder_ / name, failed);
  if (failed) return Error{ErrorCode::kIo, (folder_ / name).string() + ": " + failed.message()};
  if (!made) return exists;
  Status launched = launch(name, std::move(*read), request);
  // So that the name is free for another attempt.
  if (!launched) fs::remove_all(folder_ / name, failed);
  return launched;
}

Status SweepService::go_on(const std::string& name,
                           const SweepRequest& request,
                           SweepRefusal& refusal,
                           const std::atomic<bool>* cancel) {
  const std::unique_lock launching(launching_, std::try_to_lock);
  const Result<Json> own = document(name);
  if (!own) return own.error();
  if (Status free = check_free(refusal); !free) return free;
  if (!launching) {
    refusal = SweepRefusal::kBusy;
    return Error{ErrorCode::kConflict, "another sweep is being started: try again soon"};
  }
  if (RunLock::held(folder_ / name)) {
    return Error{ErrorCode::kConflict, "sweep \"" + name + "\" is flown by another process"};
  }
  const Json& wanted = request.document.is_null() ? *own : request.document;
  Result<ClientSweep> read = read_client_sweep(runs_, wanted, refusal, cancel);
  if (!read) return read.error();
  return launch(name, std::move(*read), request);
}

Status SweepService::launch(const std::string& name,
                            ClientSweep sweep,
                            const SweepRequest& request) {
  std::optional<BorderSearch> border = request.border;
  if (border) {
    Status status = check_border(*sweep.sweep, sweep.plan.estimators(), *border);
    if (!status) return status;
  }
  const fs::path folder = folder_ / name;
  if (Status status = write_sweep(*sweep.sweep, sweep.plan, folder); !status) return status;
  if (border) {
    Status status = write_border_search(folder, *sweep.sweep, *border);
    if (!status) return status;
  } else if (!request.document.is_null()) {
    remove_envelope(folder);  // It was that of another document.
  }
  const std::lock_guard lock(mutex_);
  if (stopping_) return Error{ErrorCode::kConflict, "the server is stopping"};
  if (thread_.joinable()) thread_.join();  // It has ended: a sweep in progress was refused above.
  const std::shared_ptr<Flight> flight(new Flight{name,
                                                  std::move(sweep),
                                                  request.jobs == 0 ? default_jobs() : request.jobs,
                                                  std::move(border)});
  problems_.erase(name);
  try {
    thread_ = std::thread([this, flight] { fly(*flight); });
  } catch (const std::system_error& error) {
    return Error{ErrorCode::kInternal,
                 std::string("no thread for the sweep can be started: ") + error.what()};
  }
  flight_ = flight;
  return {};
}

Status SweepService::fly_into(const Flight& flight, const fs::path& folder) {
  if (options_.begin_thread) options_.begin_thread();
  SweepOptions options;
  options.folder = folder;
  options.program = options_.program;
  options.flight_options = flight.sweep.flight_options;
  options.jobs = flight.jobs;
  options.frame_cache = {
      fs::absolute(folder_ / kSharedFrameCache), options_.frame_cache_gib, utc_now_ns()};
  options.hold_memory = [this](const RunMemory& memory) { return runs_.hold_memory(memory); };
  options.cancel = &flight.cancel;
  options.warn = [&](const std::string& text) { log("warning", flight.name, text); };
  const Sweep& sweep = *flight.sweep.sweep;
  if (flight.border) {
    const Result<Envelope> envelope = find_envelope(sweep, {options, *flight.border, {}});
    if (!envelope && envelope.error().code == ErrorCode::kCancelled) return {};
    if (!envelope) return envelope.error();
    if (Status status = write_envelope(folder, *envelope); !status) return status;
    const Result<FlownSweep> flown = read_sweep(sweep, folder, options.cancel);
    if (!flown && flown.error().code == ErrorCode::kCancelled) return {};
    return flown ? write_summary(sweep, *flown, folder) : Status(flown.error());
  }
  const Result<FlownSweep> flown = fly_sweep(sweep, options);
  if (!flown && flown.error().code == ErrorCode::kCancelled) return {};
  if (!flown) return flown.error();
  return write_summary(sweep, *flown, folder);
}

void SweepService::fly(Flight& flight) {
  const Status ended =
      guarded([&] { return fly_into(flight, fs::absolute(folder_ / flight.name)); });
  const std::lock_guard lock(mutex_);
  // Without memory for the reason the sweep is over all the same.
  (void)contained(
      [&] {
        if (ended) return;
        problems_[flight.name] = ended.error().message;
        log("error", flight.name, ended.error().message);
      },
      [](const char*) {});
  flight.over = true;
}

void SweepService::log(const char* level, const std::string& name, const std::string& text) const {
  if (options_.log) options_.log(level, "sweep " + name + ": " + text);
}

Status SweepService::cancel(const std::string& name) {
  const Result<Json> known = sweep_entry(folder_, name);
  if (!known) return known.error();
  const std::lock_guard lock(mutex_);
  if (!is_busy() || flight_->name != name) {
    return Error{ErrorCode::kConflict, "sweep \"" + name + "\" is not flown by this server"};
  }
  flight_->cancel = true;
  return {};
}

Status SweepService::remove(const std::string& name) {
  // So that it is not continued meanwhile.
  const std::unique_lock launching(launching_, std::try_to_lock);
  const Result<Json> known = sweep_entry(folder_, name);
  if (!known) return known.error();
  if (!launching) {
    return Error{ErrorCode::kConflict, "a sweep is being started or deleted: try again soon"};
  }
  {
    const std::lock_guard lock(mutex_);
    if (is_busy() && flight_->name == name) {
      return Error{ErrorCode::kConflict,
                   "sweep \"" + name + "\" is flying: cancel it and wait for its end"};
    }
  }
  // Through a symbolic link too.
  if (RunLock::held(folder_ / name)) {
    return Error{ErrorCode::kConflict, "sweep \"" + name + "\" is flown by another process"};
  }
  const Result<fs::path> aside = put_run_folder_aside(folder_ / name);
  if (!aside) return aside.error();
  {
    const std::lock_guard lock(mutex_);
    problems_.erase(name);
  }
  delete_later(*aside);
  return {};
}

void SweepService::delete_later(const fs::path& folder) {
  const auto work = [this, folder] {
    std::error_code failure;
    fs::remove_all(folder, failure);
    if (failure) {
      log("error", folder.filename().string(), "cannot be deleted: " + failure.message());
    }
  };
  std::future<void> deletion;
  try {
    deletion = std::async(std::launch::async, work);
  } catch (const std::system_error&) {
    work();  // There is no thread for it.
    return;
  }
  const std::lock_guard lock(mutex_);
  std::erase_if(deletions_, [](const std::future<void>& earlier) {
    return earlier.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  deletions_.push_back(std::move(deletion));
}

void SweepService::request_stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  if (flight_) flight_->cancel = true;
}

void SweepService::stop() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

}  // namespace overfly::server::experiments
