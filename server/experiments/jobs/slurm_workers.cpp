#include "server/experiments/jobs/slurm_workers.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/text/number_text.hpp"
#include "server/experiments/jobs/command_output.hpp"
#include "server/experiments/jobs/job_folder.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::string_view kNamePrefix = "overfly-";
constexpr std::uint64_t kMaxNameBytes = 4096;
constexpr double kCommandTimeout_s = 60.0;
/// Attempts to submit the first tasks, and submissions whose tasks all end without a flight.
constexpr int kMostAttempts = 3;
/// Slurm's own default limit for one array is 1001 (MaxArraySize); later arrays fill up.
constexpr std::size_t kMostTasksOfArray = 1000;

fs::path slurm_folder(const SlurmOptions& options) {
  return JobFolder(options.sweep).part("slurm");
}

/// "overfly-9f3a2c01": nothing else may be given to scancel.
bool is_own_name(const std::string& name) {
  constexpr std::size_t kDigits = 8;
  return name.starts_with(kNamePrefix) && name.size() == kNamePrefix.size() + kDigits &&
         name.find_first_not_of("0123456789abcdef", kNamePrefix.size()) == std::string::npos;
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string one_line(std::string text) {
  constexpr std::size_t kLongest = 500;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.substr(0, kLongest);
}

Result<std::string> run_slurm(const std::vector<std::string>& words) {
  const Result<CommandOutput> output = command_output(words, kCommandTimeout_s);
  if (!output) return output.error();
  if (output->exit_code == 0) return output->text;
  return Error{ErrorCode::kUnsupported,
               words.front() + ": exit code " + std::to_string(output->exit_code) + ": " +
                   one_line(output->text)};
}

/// Memory of a task [MiB]: that of a flight, and what the program needs without images and maps;
/// and enough for the worker to accept the flight.
std::uint64_t task_memory_mib(const RunMemory& memory) {
  constexpr std::uint64_t kProgramBytes = std::uint64_t{512} << 20U;
  constexpr std::uint64_t kMib = std::uint64_t{1} << 20U;
  const std::uint64_t needed = memory.images_bytes + memory.caches_bytes + kProgramBytes;
  return (std::max(needed, MemoryBudget::least_machine_bytes(memory)) + kMib - 1) / kMib;
}

/// Slurm's reason for a task that could not be started on a node and will not be tried again.
constexpr const char* kNotLaunched = "launch failed requeued held";

struct QueuedTask {
  std::string id;  ///< "17_0"
  std::string state;
  std::string reason;
};

/// From lines "17_0|PENDING|Resources"; what is no such line is left out.
std::vector<QueuedTask> queued_tasks(const std::string& list) {
  std::vector<QueuedTask> tasks;
  std::istringstream lines(list);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    QueuedTask task;
    std::getline(fields, task.id, '|');
    std::getline(fields, task.state, '|');
    std::getline(fields, task.reason);
    const bool is_id =
        !task.id.empty() && task.id.find_first_not_of("0123456789_") == std::string::npos;
    if (is_id && !task.state.empty()) tasks.push_back(std::move(task));
  }
  return tasks;
}

bool waits_for_its_turn(const std::string& reason) {
  return reason == "None" || reason == "Priority" || reason == "Resources" || reason == "BeginTime";
}

}  // namespace

Result<std::unique_ptr<SlurmWorkers>> SlurmWorkers::open(SlurmOptions options) {
  const Result<std::string> version = run_slurm({"sbatch", "--version"});
  if (!version) return version.error();
  std::unique_ptr<SlurmWorkers> workers(new SlurmWorkers(std::move(options)));
  std::error_code error;
  const fs::path folder = slurm_folder(workers->options_);
  fs::create_directories(folder, error);
  if (error) {
    return Error{ErrorCode::kIo, folder.string() + ": cannot create: " + error.message()};
  }
  if (Status status = workers->load_name(); !status) return status.error();
  if (Status status = workers->write_script(); !status) return status.error();
  return workers;
}

Status SlurmWorkers::load_name() {
  const fs::path file = slurm_folder(options_) / "name.json";
  const Result<Json> read = read_json(file, kMaxNameBytes);
  if (!read && read.error().code != ErrorCode::kNotFound) return read.error();
  if (read) {
    const bool has_name = read->is_object() && read->contains("job_name") &&
                          (*read)["job_name"].is_string() && is_own_name((*read)["job_name"]);
    if (!has_name) {
      return Error{ErrorCode::kUnreadable,
                   file.string() +
                       ": job_name is no name that a sweep gives its tasks; remove the "
                       "file if none of them is queued or runs"};
    }
    name_ = (*read)["job_name"];
    return {};
  }
  name_ = std::string(kNamePrefix) + random_name();
  return write_json(file, {{"job_name", name_}});
}

Status SlurmWorkers::write_script() const {
  // exec: the signals of Slurm reach the worker. An idle task gives its place to other users.
  std::string script = "#!/bin/sh\nexec " + quoted(options_.program.string()) + " sweep work " +
                       quoted(options_.sweep.string()) + " --jobs 1 --idle-s 5";
  for (const std::string& option : options_.worker_options) script += " " + quoted(option);
  return write_whole(slurm_folder(options_) / "worker.sh", script + "\n");
}

std::optional<std::size_t> SlurmWorkers::tasks() {
  const Result<std::string> list =
      run_slurm({"squeue", "--noheader", "--array", "--name=" + name_, "--format=%i|%T|%r"});
  if (!list) {
    if (!silent_ && options_.warn) {
      options_.warn(list.error().message + "; flights go on, workers are counted when it answers");
    }
    silent_ = true;
    return std::nullopt;
  }
  if (silent_ && options_.warn) options_.warn("squeue answers again");
  silent_ = false;
  std::size_t count = 0;
  std::vector<std::string> held;
  std::string reason;
  bool one_runs = false;
  for (const QueuedTask& task : queued_tasks(*list)) {
    if (task.reason == kNotLaunched) {
      held.push_back(task.id);
      continue;
    }
    ++count;
    if (task.state != "PENDING") {
      one_runs = true;
    } else if (!waits_for_its_turn(task.reason)) {
      reason = task.reason;
    }
  }
  if (!held.empty()) cancel_held(held);
  report_waiting(one_runs ? "" : reason);
  return count;
}

void SlurmWorkers::cancel_held(const std::vector<std::string>& tasks) {
  // The name and the state limit what a wrong id could end.
  std::vector<std::string> words{"scancel", "--name=" + name_, "--state=PENDING"};
  words.insert(words.end(), tasks.begin(), tasks.end());
  const Result<std::string> cancelled = run_slurm(words);
  if (!options_.warn) return;
  options_.warn("Slurm could not launch " + counted(tasks.size(), "task") +
                " and holds what it could not launch: replaced");
  if (!cancelled) options_.warn(cancelled.error().message);
}

void SlurmWorkers::report_waiting(const std::string& reason) {
  if (reason != waiting_ && !reason.empty() && options_.warn) {
    options_.warn("no task runs; Slurm's reason: " + reason);
  }
  waiting_ = reason;
}

double SlurmWorkers::pause_s() const {
  constexpr double kFirst_s = 2.0;
  constexpr int kMostDoublings = 10;
  const double doubled = kFirst_s * static_cast<double>(1 << std::min(failures_, kMostDoublings));
  return std::min(doubled, options_.patience_s);
}

Status SlurmWorkers::refused(const std::string& reason) {
  ++failures_;
  if (!submitted_ && failures_ >= kMostAttempts) {
    return Error{ErrorCode::kUnsupported, reason};
  }
  if (options_.warn) options_.warn(reason + "; tried again");
  return {};
}

Status SlurmWorkers::submit(std::size_t tasks, const RunMemory& memory) {
  std::vector<std::string> words{"sbatch",
                                 "--parsable",
                                 "--requeue",
                                 "--job-name=" + name_,
                                 "--array=0-" + std::to_string(tasks - 1),
                                 "--mem=" + std::to_string(task_memory_mib(memory)) + "M",
                                 "--chdir=" + options_.sweep.string(),
                                 // Relative: a % in the sweep's path would be replaced.
                                 "--output=jobs/slurm/%A_%a.txt"};
  words.insert(words.end(), options_.submit_options.begin(), options_.submit_options.end());
  words.push_back((slurm_folder(options_) / "worker.sh").string());
  const Result<std::string> answer = run_slurm(words);
  if (!answer) return refused(answer.error().message);
  failures_ = 0;
  submitted_ = true;
  return {};
}

Status SlurmWorkers::keep(const FlightCounts& flights, const RunMemory& memory) {
  if (flights.untaken < flights.open) fruitless_ = 0;
  const auto now = Clock::now();
  const auto after = [now](double seconds) {
    return now +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  };
  if (flights.untaken == 0 || now < next_question_) return {};
  next_question_ = after(options_.period_s);
  const std::optional<std::size_t> there = tasks();
  const std::size_t wanted = std::min(flights.open, options_.workers);
  if (!there || *there >= wanted || now < next_submission_) return {};
  const bool fruitless = submitted_ && *there == 0 && flights.delivered == delivered_at_submission_;
  fruitless_ = fruitless ? fruitless_ + 1 : 0;
  if (fruitless_ >= kMostAttempts) {
    return Error{ErrorCode::kUnsupported,
                 "Slurm's tasks ended " + std::to_string(fruitless_) +
                     " times without a flight; see " + slurm_folder(options_).string()};
  }
  delivered_at_submission_ = flights.delivered;
  Status status = submit(std::min({wanted - *there, flights.untaken, kMostTasksOfArray}), memory);
  next_submission_ = after(pause_s());
  return status;
}

void SlurmWorkers::stop() {
  const Result<std::string> cancelled = run_slurm({"scancel", "--name=" + name_});
  if (!cancelled && options_.warn) {
    options_.warn(cancelled.error().message + "; its workers end by themselves");
  }
}

}  // namespace overfly::server::experiments
