#include "server/experiments/flight_process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

namespace overfly::server::experiments {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string reason_of(int status) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return "signal " + std::to_string(number) + " (" + ::strsignal(number) + ")";
  }
  const int code = WEXITSTATUS(status);
  return code == 0 ? "" : "exit code " + std::to_string(code);
}

/// In the child, after fork: only calls that are safe there.
[[noreturn]] void become(const char* program, char* const* arguments, int output, pid_t parent) {
  constexpr int kCannotStart = 127;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotStart);
  ::setpgid(0, 0);             // Ctrl-C reaches the parent, which stops its children in order.
  ::signal(SIGPIPE, SIG_DFL);  // A server ignores it, and exec keeps that.
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  // A server's sockets must not live on in a flight. Kernels before 5.9 lack this call.
  ::close_range(STDERR_FILENO + 1, ~0U, 0);
  ::execv(program, arguments);
  ::_exit(kCannotStart);
}

}  // namespace

FlightProcesses::~FlightProcesses() {
  for (const Child& child : children_) {
    ::kill(child.pid, SIGKILL);
    ::waitpid(child.pid, nullptr, 0);
  }
}

Status FlightProcesses::start(const FlightJob& job) {
  const int output =
      ::open(job.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (output < 0) {
    return Error{ErrorCode::kIo,
                 job.output.string() + ": " + std::generic_category().message(errno)};
  }
  std::vector<std::string> words{
      program_.string(), "run", job.scenario.string(), "--out", job.folder.string(), "--quiet"};
  words.insert(words.end(), options_.begin(), options_.end());
  words.insert(words.end(), job.options.begin(), job.options.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) become(arguments[0], arguments.data(), output, parent);
  const int number = errno;
  ::close(output);
  if (pid < 0) {
    return Error{ErrorCode::kInternal,
                 "cannot start a process for a flight: " + std::generic_category().message(number)};
  }
  children_.push_back({pid, job, Clock::now(), false});
  return {};
}

Result<std::optional<EndedFlight>> FlightProcesses::ended() {
  for (std::size_t i = 0; i < children_.size(); ++i) {
    Child& child = children_[i];
    int status = 0;
    const pid_t pid = ::waitpid(child.pid, &status, WNOHANG);
    if (pid == child.pid) {
      EndedFlight flight{
          child.job.id, seconds_since(child.started), child.timed_out, reason_of(status)};
      children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(i));
      return std::optional(std::move(flight));
    }
    if (!child.timed_out && seconds_since(child.started) > child.job.timeout_s) {
      child.timed_out = true;
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
  constexpr double kPatience_s = 10.0;
  for (const Child& child : children_) ::kill(child.pid, SIGTERM);
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
