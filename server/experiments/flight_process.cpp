#include "server/experiments/flight_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
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
  ::setpgid(0, 0);  // Ctrl-C reaches the parent, which stops its children in order.
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
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
  std::string scenario = job.scenario.string();
  std::string folder = job.folder.string();
  std::string program = program_.string();
  std::array<std::string, 3> words{"run", "--out", "--quiet"};
  std::array<char*, 7> arguments{program.data(),
                                 words[0].data(),
                                 scenario.data(),
                                 words[1].data(),
                                 folder.data(),
                                 words[2].data(),
                                 nullptr};
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) become(program.c_str(), arguments.data(), output, parent);
  const int number = errno;
  ::close(output);
  if (pid < 0) {
    return Error{ErrorCode::kInternal,
                 "cannot start a process for a flight: " + std::generic_category().message(number)};
  }
  children_.push_back({pid, job, Clock::now(), false});
  return {};
}

std::optional<EndedFlight> FlightProcesses::ended() {
  for (std::size_t i = 0; i < children_.size(); ++i) {
    Child& child = children_[i];
    int status = 0;
    const pid_t pid = ::waitpid(child.pid, &status, WNOHANG);
    if (pid == child.pid) {
      EndedFlight flight{
          child.job.id, seconds_since(child.started), child.timed_out, reason_of(status)};
      children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(i));
      return flight;
    }
    if (!child.timed_out && seconds_since(child.started) > child.job.timeout_s) {
      child.timed_out = true;
      ::kill(child.pid, SIGKILL);
    }
  }
  return std::nullopt;
}

void FlightProcesses::stop() {
  constexpr double kPatience_s = 10.0;
  for (const Child& child : children_) ::kill(child.pid, SIGTERM);
  const auto start = Clock::now();
  while (!children_.empty() && seconds_since(start) < kPatience_s) {
    if (!ended()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (const Child& child : children_) {
    ::kill(child.pid, SIGKILL);
    ::waitpid(child.pid, nullptr, 0);
  }
  children_.clear();
}

}  // namespace overfly::server::experiments
