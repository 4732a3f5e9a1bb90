#include "server/experiments/flights/flight_files.hpp"

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "core/outside/file_text.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_info_file.hpp"
#include "server/scoring/metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Status make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return {};
  return Error{ErrorCode::kIo, folder.string() + ": cannot create: " + error.message()};
}

/// The last line that a flight's process printed, for messages.
std::string last_words(const fs::path& output) {
  constexpr std::uint64_t kMostOutputBytes = std::uint64_t{16} << 20U;
  constexpr std::size_t kLongestWords = 500;
  const Result<std::string> text = read_file_text(output, kMostOutputBytes);
  if (!text) return "";
  std::string words = *text;
  while (!words.empty() && words.back() == '\n') words.pop_back();
  words = words.substr(words.rfind('\n') + 1);
  return words.substr(0, kLongestWords);
}

}  // namespace

Status FlightFiles::create() const {
  for (const char* name : {"runs", "scenarios", "output"}) {
    if (Status status = make_folder(folder_ / name); !status) return status;
  }
  return {};
}

fs::path FlightFiles::run(const std::string& id) const { return folder_ / "runs" / id; }

fs::path FlightFiles::output(const std::string& id) const {
  return folder_ / "output" / (id + ".txt");
}

bool FlightFiles::is_completed(const std::string& id) const {
  const Result<RunInfo> info = read_run_info(run(id));
  return info && info->status == RunStatus::kCompleted && none_ran(id).empty();
}

std::string FlightFiles::none_ran(const std::string& id) const {
  const Result<RunMetrics> metrics = read_run_metrics(run(id));
  if (!metrics) return "";  // The reader of the results reports it.
  const std::map<std::string, std::string> reasons = never_ran(*metrics);
  if (reasons.size() < metrics->estimators.size()) return "";
  std::string texts;
  for (const auto& [name, reason] : reasons) {
    texts += (texts.empty() ? "" : "; ") + never_ran_text(name, reason);
  }
  return texts;
}

Status FlightFiles::launch(FlightExecutor& executor,
                           const std::string& id,
                           const Scenario& scenario,
                           double timeout_s,
                           std::vector<std::string> options) const {
  std::error_code error;
  fs::remove_all(run(id), error);
  if (error) {
    return Error{ErrorCode::kIo, run(id).string() + ": cannot be removed: " + error.message()};
  }
  const fs::path file = folder_ / "scenarios" / (id + ".json");
  if (Status status = write_json(file, scenario.resolved); !status) return status;
  return executor.start(
      {id, file, run(id), output(id), timeout_s, memory_of(scenario), std::move(options)});
}

std::string FlightFiles::failure(const EndedFlight& ended, double timeout_s) const {
  if (ended.timed_out) return "took longer than timeout_s = " + Json(timeout_s).dump();
  const Result<RunInfo> info = read_run_info(run(ended.id));
  if (info && info->status == RunStatus::kCompleted && info->problem.empty()) {
    return none_ran(ended.id);
  }
  if (info && !info->problem.empty()) return info->problem;
  if (info && !info->error.empty()) return info->error;
  const std::string words = last_words(output(ended.id));
  return ended.reason.empty() ? "no run was recorded"
                              : ended.reason + (words.empty() ? "" : ": " + words);
}

std::string never_ran_text(const std::string& estimator, const std::string& reason) {
  return "estimator " + estimator + " never ran: " + reason;
}

}  // namespace overfly::server::experiments
