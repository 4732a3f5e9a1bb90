#include "server/experiments/flights/program_process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

namespace overfly::server::experiments {
namespace {

/// In the child, after fork: only calls that are safe there.
[[noreturn]] void become(const char* program, char* const* arguments, int output, pid_t parent) {
  constexpr int kCannotStart = 127;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotStart);
  ::setpgid(0, 0);             // Ctrl-C reaches the parent, which stops its children in order.
  ::signal(SIGPIPE, SIG_DFL);  // A server ignores it, and exec keeps that.
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  // A server's sockets must not live on in a child. Kernels before 5.9 lack this call.
  ::close_range(STDERR_FILENO + 1, ~0U, 0);
  ::execv(program, arguments);
  ::_exit(kCannotStart);
}

}  // namespace

Result<pid_t> start_program(std::vector<std::string> words, const std::filesystem::path& output) {
  const int file =
      ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (file < 0) {
    return Error{ErrorCode::kIo, output.string() + ": " + std::generic_category().message(errno)};
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) become(arguments[0], arguments.data(), file, parent);
  const int number = errno;
  ::close(file);
  if (pid < 0) {
    return Error{ErrorCode::kInternal,
                 "cannot start a process: " + std::generic_category().message(number)};
  }
  return pid;
}

std::string end_reason(int status) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return "signal " + std::to_string(number) + " (" + ::strsignal(number) + ")";
  }
  const int code = WEXITSTATUS(status);
  return code == 0 ? "" : "exit code " + std::to_string(code);
}

}  // namespace overfly::server::experiments
