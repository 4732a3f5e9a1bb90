#include "server/experiments/flights/flight_process.hpp"

#include <sys/wait.h>

#include <csignal>
#include <thread>
#include <utility>

#include "server/experiments/flights/program_process.hpp"

namespace overfly::server::experiments {
namespace {

using Clock = std::chrono::steady_clock;

/// Time for a flight to end its estimators, which would outlive it, and to complete its folder.
constexpr double kPatience_s = 10.0;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

FlightProcesses::~FlightProcesses() {
  for (const Child& child : children_) {
    ::kill(child.pid, SIGKILL);
    ::waitpid(child.pid, nullptr, 0);
  }
}

Status FlightProcesses::start(const FlightJob& job) {
  std::vector<std::string> words{
      program_.string(), "run", job.scenario.string(), "--out", job.folder.string(), "--quiet"};
  words.insert(words.end(), options_.begin(), options_.end());
  words.insert(words.end(), job.options.begin(), job.options.end());
  const Result<pid_t> pid = start_program(std::move(words), job.output);
  if (!pid) return pid.error();
  children_.push_back({*pid, job, Clock::now(), std::nullopt});
  return {};
}

Result<std::optional<EndedFlight>> FlightProcesses::ended() {
  for (std::size_t i = 0; i < children_.size(); ++i) {
    Child& child = children_[i];
    int status = 0;
    const pid_t pid = ::waitpid(child.pid, &status, WNOHANG);
    if (pid == child.pid) {
      EndedFlight flight{child.job.id,
                         seconds_since(child.started),
                         child.timed_out.has_value(),
                         end_reason(status)};
      children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(i));
      return std::optional(std::move(flight));
    }
    if (!child.timed_out && seconds_since(child.started) > child.job.timeout_s) {
      child.timed_out = Clock::now();
      ::kill(child.pid, SIGTERM);
    }
    if (child.timed_out && seconds_since(*child.timed_out) > kPatience_s) {
      ::kill(child.pid, SIGKILL);
    }
  }
  return std::optional<EndedFlight>();
}

void FlightProcesses::kill(const std::string& id) {
  for (const Child& child : children_) {
    if (child.job.id != id) continue;
    ::kill(child.pid, SIGKILL);
    ::waitpid(child.pid, nullptr, 0);
  }
  std::erase_if(children_, [&](const Child& child) { return child.job.id == id; });
}

void FlightProcesses::stop() {
  // A second signal would end at once a flight that was already asked to end.
  for (const Child& child : children_) {
    if (!child.timed_out) ::kill(child.pid, SIGTERM);
  }
  const auto start = Clock::now();
  while (!children_.empty() && seconds_since(start) < kPatience_s) {
    if (!*ended()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (const Child& child : children_) {
    ::kill(child.pid, SIGKILL);
    ::waitpid(child.pid, nullptr, 0);
  }
  children_.clear();
}

}  // namespace overfly::server::experiments
