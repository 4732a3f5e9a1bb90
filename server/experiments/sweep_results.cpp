#include "server/experiments/sweep_results.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"
#include "server/experiments/keys/plain_numbers.hpp"
#include "server/files/plain_name.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kMaxResultsBytes = std::uint64_t{1} << 30U;

constexpr const char* kWithdrawn = "withdrawn";

const char* status_of(const SweepResult& result) {
  if (result.withdrawn) return kWithdrawn;
  return result.completed() ? "completed" : "failed";
}

Json json_of_result(const SweepResult& result) {
  return {{"key", result.key},
          {"cell", result.cell},
          {"repeat", result.repeat},
          {"seed", result.seed},
          {"estimator", result.estimator},
          {"run", result.run},
          {"status", status_of(result)},
          {"error", result.error},
          {"outcome", result.completed() ? evaluation::to_string(result.outcome) : ""},
          {"duration_s", result.duration_s}};
}

/// Whether a run's folder is one of the sweep's own: "runs/NAME". The file may have come from
/// anywhere, and what it names is read.
bool is_run_of_sweep(const std::string& run) {
  constexpr std::string_view kFolder = "runs/";
  return run.starts_with(kFolder) && is_plain_name(run.substr(kFolder.size()));
}

std::optional<SweepResult> result_from(const Json& line) {
  try {
    SweepResult result;
    result.key = line.at("key").get<std::string>();
    result.cell = line.at("cell");
    result.repeat = line.at("repeat").get<int>();
    result.seed = line.at("seed").get<std::uint64_t>();
    result.estimator = line.at("estimator").get<std::string>();
    result.run = line.at("run").get<std::string>();
    if (!is_run_of_sweep(result.run)) return std::nullopt;
    result.error = line.at("error").get<std::string>();
    result.duration_s = line.at("duration_s").get<double>();
    const auto status = line.at("status").get<std::string>();
    if (status == "failed") {
      if (result.error.empty()) result.error = "failed";
      return result;
    }
    if (status == kWithdrawn) {
      result.withdrawn = true;
      return result;
    }
    const auto outcome = evaluation::outcome_from(line.at("outcome").get<std::string>());
    if (status != "completed" || !result.completed() || !outcome) return std::nullopt;
    result.outcome = *outcome;
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// The same for other versions of the program and of the estimator, and for another seed of the
/// sweep's scenario.
std::string flight_identity(const SweepResult& result) {
  const Json flight = {result.cell, result.repeat, result.estimator};
  return flight.dump();
}

Error results_error(const fs::path& file, int number) {
  return {ErrorCode::kIo, file.string() + ": " + std::generic_category().message(number)};
}

/// One write, so that a kill leaves at most one line cut off.
Status append_line(const fs::path& file, const std::string& line) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) return results_error(file, errno);
  const ssize_t written = ::write(descriptor, line.data(), line.size());
  const int number = written < 0 ? errno : ENOSPC;
  ::close(descriptor);
  if (written != static_cast<ssize_t>(line.size())) return results_error(file, number);
  return {};
}

}  // namespace

Result<SweepResults> SweepResults::read(const fs::path& folder) {
  SweepResults results;
  results.file_ = folder / "results.jsonl";
  std::error_code ignored;
  if (!fs::exists(results.file_, ignored)) return results;
  const Result<std::string> text = read_file_text(results.file_, kMaxResultsBytes);
  if (!text) return text.error();
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = text->find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string_view line(text->data() + begin, end - begin);
    const auto document = json_from_outside<Json>(line, results.file_.string());
    std::optional<SweepResult> result =
        document ? result_from(*document) : std::optional<SweepResult>();
    if (result) {
      results.keep(std::move(*result));
    } else {
      ++results.lines_;
      ++results.unreadable_lines_;
    }
  }
  results.whole_lines_bytes_ = begin;
  return results;
}

Result<SweepResults> SweepResults::open(const fs::path& folder) {
  Result<SweepResults> results = read(folder);
  if (!results) return results;
  std::error_code error;
  const auto size = fs::file_size(results->file_, error);
  if (error) return results;  // there is none yet
  if (size > results->whole_lines_bytes_) {
    fs::resize_file(results->file_, results->whole_lines_bytes_, error);
  }
  if (error) return results_error(results->file_, error.value());
  return results;
}

const SweepResult* SweepResults::find(const std::string& key) const {
  const auto found = by_key_.find(key);
  return found == by_key_.end() ? nullptr : &found->second;
}

bool SweepResults::has(const SweepResult& result) const {
  SweepResult plain = result;
  plain.cell = with_plain_numbers(std::move(plain.cell));
  const auto found = by_flight_.find(flight_identity(plain));
  return found != by_flight_.end() && found->second.key == result.key &&
         found->second.error == result.error;
}

void SweepResults::keep(SweepResult result) {
  result.line = lines_++;
  result.cell = with_plain_numbers(std::move(result.cell));
  if (result.withdrawn) {
    by_flight_.erase(flight_identity(result));
    return;
  }
  by_flight_.insert_or_assign(flight_identity(result), result);
  std::string key = result.key;
  by_key_.insert_or_assign(std::move(key), std::move(result));
}

Status SweepResults::add(const SweepResult& result) {
  if (Status status = append_line(file_, json_of_result(result).dump() + "\n"); !status) {
    return status;
  }
  keep(result);
  return {};
}

Status SweepResults::withdraw(SweepResult result) {
  result.withdrawn = true;
  return add(result);
}

std::vector<const SweepResult*> SweepResults::newest() const {
  std::vector<const SweepResult*> newest;
  for (const auto& [flight, result] : by_flight_) newest.push_back(&result);
  std::sort(newest.begin(), newest.end(), [](const SweepResult* a, const SweepResult* b) {
    return a->line < b->line;
  });
  return newest;
}

}  // namespace overfly::server::experiments
