#include "server/experiments/studies/study_service.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <system_error>
#include <utility>
#include <vector>

#include "core/barrier.hpp"
#include "server/experiments/flights/program_process.hpp"
#include "server/experiments/studies/prepare_study.hpp"
#include "server/experiments/studies/study_result.hpp"
#include "server/files/file_stamp.hpp"
#include "server/files/plain_name.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_id.hpp"
#include "server/record/run_lock.hpp"
#include "server/runs/run_removal.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::chrono::milliseconds kPoll{50};
/// A process that was asked to end stops its flights within ten seconds.
constexpr std::chrono::seconds kPatience{12};
/// Below this share the time left is not known.
constexpr double kLeastShare = 0.02;

double seconds_between(std::chrono::steady_clock::time_point from,
                       std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

Error stopping_error() { return {ErrorCode::kConflict, "the server is stopping"}; }

}  // namespace

StudyService::StudyService(RunManager& runs, StudyServiceOptions options)
    : runs_(runs),
      options_(std::move(options)),
      folder_(runs.studies_folder().empty() ? fs::path() : fs::absolute(runs.studies_folder())) {
  if (!folder_.empty()) remove_leftovers(folder_);
}

std::size_t StudyService::most_jobs() {
  return std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

std::size_t StudyService::default_jobs() { return std::max<std::size_t>(1, most_jobs() / 2); }

Result<StudyFolder> StudyService::folder_of(const std::string& name) const {
  StudyFolder folder(folder_ / name);
  if (folder_.empty() || !is_plain_name(name) || !folder.exists()) {
    return Error{ErrorCode::kNotFound, "study \"" + name.substr(0, 100) + "\": no such study"};
  }
  return folder;
}

std::shared_ptr<StudyService::Active> StudyService::active(const std::string& name) const {
  for (const auto& study : queue_) {
    if (study->name == name && !study->over) return study;
  }
  return nullptr;
}

Json StudyService::progress_of(Active& study) const {
  Json progress = StudyFolder(folder_ / study.name).progress();
  const double spent_s = seconds_between(study.begun, Clock::now());
  if (progress.is_null()) progress = {{"share", 0.0}, {"text", "starting"}};
  progress["spent_s"] = spent_s;
  progress["left_s"] = nullptr;
  const double share = progress.at("share").get<double>();
  if (share == 0.0) return progress;
  if (!study.first_share) study.first_share = share < 1.0 && spent_s < 2.0 ? share : 0.0;
  const double done = share - *study.first_share;
  if (done > kLeastShare) progress["left_s"] = spent_s * (1.0 - share) / done;
  return progress;
}

Json StudyService::entry_of(const std::string& name, const StudyRecord& record) const {
  Json entry = {{"name", name},
                {"kind", to_string(record.kind)},
                {"title", record.title},
                {"subject", record.subject},
                {"estimator", record.estimator},
                {"created_utc", record.created_utc},
                {"ended_utc", nullptr},
                {"cancelling", false},
                {"position", nullptr},
                {"problem", nullptr},
                {"progress", nullptr}};
  {
    const std::lock_guard lock(mutex_);
    std::size_t position = 0;
    for (const auto& study : queue_) {
      if (study->over) continue;
      if (!study->started) ++position;
      if (study->name != name) continue;
      entry["state"] = to_string(study->started ? StudyState::kRunning : StudyState::kWaiting);
      entry["cancelling"] = study->cancel.load();
      if (study->started) entry["progress"] = progress_of(*study);
      if (!study->started) entry["position"] = position;
      return entry;
    }
  }
  const StudyFolder folder(folder_ / name);
  if (RunLock::held(folder.path())) {
    entry["state"] = to_string(StudyState::kRunning);
    entry["problem"] = "another process works on it";
    return entry;
  }
  const StudyEnd end = folder.read_end();
  entry["state"] = to_string(end.state);
  if (!end.utc.empty()) entry["ended_utc"] = end.utc;
  if (!end.problem.empty()) entry["problem"] = end.problem;
  return entry;
}

Json StudyService::list() const {
  std::vector<std::string> names;
  std::error_code failure;
  if (!folder_.empty()) {
    for (fs::directory_iterator each(folder_, failure), end; !failure && each != end;
         each.increment(failure)) {
      const std::string name = each->path().filename().string();
      if (is_plain_name(name)) names.push_back(name);
    }
  }
  // They begin with the time of their creation.
  std::sort(names.rbegin(), names.rend());
  Json studies = Json::array();
  for (const std::string& name : names) {
    if (studies.size() >= kMostKept) break;
    const Result<StudyRecord> record = StudyFolder(folder_ / name).read();
    if (record) studies.push_back(entry_of(name, *record));
  }
  return {{"studies", std::move(studies)}};
}

Result<Json> StudyService::entry(const std::string& name) const {
  const Result<StudyFolder> folder = folder_of(name);
  if (!folder) return folder.error();
  const Result<StudyRecord> record = folder->read();
  if (!record) return record.error();
  return entry_of(name, *record);
}

Result<Json> StudyService::result(const std::string& name) const {
  const Result<StudyFolder> folder = folder_of(name);
  if (!folder) return folder.error();
  const Result<StudyRecord> record = folder->read();
  if (!record) return record.error();
  return study_result(record->kind, folder->path());
}

Result<std::string> StudyService::page(const std::string& name) const {
  const Result<StudyFolder> folder = folder_of(name);
  if (!folder) return folder.error();
  const Result<StudyRecord> record = folder->read();
  if (!record) return record.error();
  return study_page(record->kind, folder->path());
}

Result<Json> StudyService::worst(const std::string& name) const {
  const Result<StudyFolder> folder = folder_of(name);
  if (!folder) return folder.error();
  return worst_scenario(folder->path());
}

Status StudyService::check_room(StudyRefusal& refusal) const {
  if (folder_.empty()) {
    refusal = StudyRefusal::kOff;
    return Error{ErrorCode::kConflict, "this server has no folder of studies"};
  }
  if (stopping_) return stopping_error();
  refusal = StudyRefusal::kFull;
  {
    const std::lock_guard lock(mutex_);
    if (queue_.size() > kMostWaiting) {
      return Error{ErrorCode::kConflict,
                   "waiting studies = " + std::to_string(queue_.size() - 1) + ": must be below " +
                       std::to_string(kMostWaiting) + ": wait for one, or cancel one"};
    }
  }
  std::error_code failed;
  const fs::directory_iterator entries(folder_, failed);
  const auto count = failed ? 0 : std::distance(begin(entries), end(entries));
  if (static_cast<std::size_t>(count) >= kMostKept) {
    return Error{ErrorCode::kConflict,
                 "studies = " + std::to_string(count) + ": must be below " +
                     std::to_string(kMostKept) + ": delete some of them"};
  }
  refusal = StudyRefusal::kNone;
  return {};
}

Result<std::string> StudyService::start(const StudyRequest& request,
                                        StudyRefusal& refusal,
                                        const std::atomic<bool>* cancel) {
  if (Status room = check_room(refusal); !room) return room.error();
  std::error_code failed;
  fs::create_directories(folder_, failed);
  if (failed) return Error{ErrorCode::kIo, folder_.string() + ": " + failed.message()};
  const Result<std::string> name = reserve_run(folder_, to_string(request.kind()), utc_now_ns());
  if (!name) return name.error();
  StudyRequest asked = request;
  if (asked.jobs == 0) asked.jobs = default_jobs();
  Result<StudyRecord> record =
      prepare_study(runs_, asked, StudyFolder(folder_ / *name), refusal, cancel);
  Status queued = record ? enqueue(*name, std::move(*record)) : Status(record.error());
  if (queued) return *name;
  fs::remove_all(folder_ / *name, failed);
  return queued.error();
}

Status StudyService::go_on(const std::string& name, StudyRefusal& refusal) {
  const Result<StudyFolder> folder = folder_of(name);
  if (!folder) return folder.error();
  Result<StudyRecord> record = folder->read();
  if (!record) return record.error();
  const bool held = RunLock::held(folder->path());
  {
    const std::lock_guard lock(mutex_);
    if (held || active(name)) {
      return Error{ErrorCode::kConflict, "study \"" + name + "\" has not ended"};
    }
  }
  if (Status room = check_room(refusal); !room) return room;
  if (Status allowed = check_again(runs_, *record, *folder, refusal); !allowed) return allowed;
  return enqueue(name, std::move(*record));
}

Status StudyService::enqueue(const std::string& name, StudyRecord record) {
  const std::lock_guard lock(mutex_);
  if (stopping_) return stopping_error();
  if (active(name)) return Error{ErrorCode::kConflict, "study \"" + name + "\" has not ended"};
  if (!thread_.joinable()) {
    try {
      thread_ = std::thread([this] { work(); });
    } catch (const std::system_error& error) {
      return Error{ErrorCode::kInternal,
                   std::string("no thread for studies can be started: ") + error.what()};
    }
  }
  const auto study = std::make_shared<Active>();
  study->name = name;
  study->record = std::move(record);
  StudyFolder(folder_ / name).begin_again();
  queue_.push_back(study);
  wake_.notify_all();
  return {};
}

void StudyService::work() {
  if (options_.begin_thread) options_.begin_thread();
  for (;;) {
    std::shared_ptr<Active> next;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
      if (queue_.empty()) return;
      next = queue_.front();
    }
    (void)contained([&] { make(*next); },
                    [&](const char* reason) { log("error", next->name, reason); });
    const std::lock_guard lock(mutex_);
    next->over = true;
    queue_.remove(next);
  }
}

void StudyService::make(Active& study) {
  const StudyFolder folder(folder_ / study.name);
  StudyEnd end = run_process(study, folder);
  end.utc = utc_text(utc_now_ns());
  if (end.state == StudyState::kFailed) log("error", study.name, end.problem);
  if (Status status = folder.write_end(end); !status) {
    log("error", study.name, status.error().message);
  }
}

std::shared_ptr<const void> StudyService::wait_for_memory(const Active& study) const {
  RunMemory together = study.record.memory;
  const bool flies = study.record.kind != StudyKind::kPredict;
  for (std::size_t job = 1; flies && job < study.record.jobs; ++job) {
    together += study.record.memory;
  }
  while (!must_end(study)) {
    if (auto held = runs_.hold_memory(together)) return held;
    std::this_thread::sleep_for(kPoll);
  }
  return nullptr;
}

StudyEnd StudyService::run_process(Active& study, const StudyFolder& folder) {
  const std::shared_ptr<const void> memory = wait_for_memory(study);
  const StudyEnd stopped{study.cancel ? StudyState::kCancelled : StudyState::kInterrupted,
                         study.cancel ? "" : "the server was stopped",
                         ""};
  if (!memory) return stopped;
  Result<std::vector<std::string>> words = study_arguments(runs_, study.record, folder);
  if (!words) return {StudyState::kFailed, words.error().message, ""};
  words->insert(words->begin(), options_.program.string());
  {
    const std::lock_guard lock(mutex_);
    study.begun = Clock::now();
    study.started = true;
  }
  const Result<pid_t> pid = start_program(std::move(*words), folder.output_file());
  if (!pid) return {StudyState::kFailed, pid.error().message, ""};
  std::optional<Clock::time_point> asked;
  int status = 0;
  while (::waitpid(*pid, &status, WNOHANG) != *pid) {
    const auto now = Clock::now();
    if (must_end(study) && !asked) {
      asked = now;
      ::kill(*pid, SIGTERM);
    }
    // Its flights are killed with it.
    if (asked && now - *asked > kPatience) ::kill(*pid, SIGKILL);
    std::this_thread::sleep_for(kPoll);
  }
  return end_by_process(study, folder, status);
}

StudyEnd StudyService::end_by_process(const Active& study,
                                      const StudyFolder& folder,
                                      int status) const {
  const std::string reason = end_reason(status);
  if (reason.empty()) return {StudyState::kDone, "", ""};
  if (study.cancel) return {StudyState::kCancelled, "", ""};
  if (stopping_) return {StudyState::kInterrupted, "the server was stopped", ""};
  const std::string printed = folder.printed_error();
  return {StudyState::kFailed, printed.empty() ? "its process ended: " + reason : printed, ""};
}

void StudyService::log(const char* level, const std::string& name, const std::string& text) const {
  if (options_.log) options_.log(level, "study " + name + ": " + text);
}

Status StudyService::cancel(const std::string& name) {
  if (const Result<StudyFolder> folder = folder_of(name); !folder) return folder.error();
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<Active> study = active(name);
  if (!study) return Error{ErrorCode::kConflict, "study \"" + name + "\" is not made here"};
  study->cancel = true;
  // One behind another that is made ends here and now.
  if (study == queue_.front()) return {};
  study->over = true;
  queue_.remove(study);
  return StudyFolder(folder_ / name)
      .write_end({StudyState::kCancelled, "", utc_text(utc_now_ns())});
}

Status StudyService::remove(const std::string& name) {
  const Result<StudyFolder> folder = folder_of(name);
  if (!folder) return folder.error();
  {
    const std::lock_guard lock(mutex_);
    if (active(name)) {
      return Error{ErrorCode::kConflict, "study \"" + name + "\" has not ended: cancel it first"};
    }
  }
  // If it is begun again meanwhile, its process finds no folder, or this call finds it locked.
  return remove_run_folder(folder->path());
}

void StudyService::request_stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  wake_.notify_all();
}

void StudyService::stop() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

}  // namespace overfly::server::experiments
