#include "server/experiments/jobs/command_output.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>

#include "core/outside/file_descriptor.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to programs

namespace overfly::server::experiments {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostOutputText = std::size_t{4} << 20U;

Error cannot_run(const std::string& program, const std::string& reason, ErrorCode code) {
  return {code, program + ": " + reason};
}

/// Reads until the other end is closed. False if that did not happen in time.
bool read_all(int descriptor, Clock::time_point end, std::string& text) {
  std::array<char, 65536> piece{};
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0) return false;
    pollfd wait{descriptor, POLLIN, 0};
    const int ready = ::poll(&wait, 1, static_cast<int>(std::min<long>(left.count(), 1000)));
    if (ready <= 0) continue;
    const ssize_t size = ::read(descriptor, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return true;
    const std::size_t room = kMostOutputText - text.size();
    text.append(piece.data(), std::min(room, static_cast<std::size_t>(size)));
  }
}

/// False if the process did not end in time and was killed.
bool wait_for(pid_t pid, Clock::time_point end, int& status) {
  constexpr auto kPeriod = std::chrono::milliseconds(5);
  for (;;) {
    const pid_t ended = ::waitpid(pid, &status, WNOHANG);
    if (ended == pid || (ended < 0 && errno != EINTR)) return true;
    if (Clock::now() >= end) break;
    std::this_thread::sleep_for(kPeriod);
  }
  ::kill(pid, SIGKILL);
  ::waitpid(pid, &status, 0);
  return false;
}

}  // namespace

Result<CommandOutput> command_output(const std::vector<std::string>& words, double timeout_s) {
  const std::string& program = words.front();
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return cannot_run(program, std::generic_category().message(errno), ErrorCode::kInternal);
  }
  const FileDescriptor reading(ends[0]);
  posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int failed =
      ::posix_spawnp(&pid, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (failed != 0) {
    return cannot_run(program,
                      std::generic_category().message(failed),
                      failed == ENOENT ? ErrorCode::kNotFound : ErrorCode::kInternal);
  }
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(timeout_s));
  CommandOutput output;
  const bool read = read_all(reading.get(), end, output.text);
  int status = 0;
  const bool in_time = wait_for(pid, read ? end : Clock::now(), status) && read;
  if (!in_time) {
    return cannot_run(program,
                      "did not end within " + std::to_string(static_cast<long>(timeout_s)) + " s",
                      ErrorCode::kInternal);
  }
  if (!WIFEXITED(status)) {
    return cannot_run(
        program, "was ended by signal " + std::to_string(WTERMSIG(status)), ErrorCode::kInternal);
  }
  output.exit_code = WEXITSTATUS(status);
  return output;
}

}  // namespace overfly::server::experiments
