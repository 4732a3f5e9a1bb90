#include "vo_bridges/process/child/child_start.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "core/outside/file_descriptor.hpp"

namespace overfly::process {

namespace {

enum class Step : int { kParent, kStreams, kFolder, kCpus, kMemory, kExec };

/// Report of a child that could not be started.
struct Failure {
  Step step = Step::kExec;
  int number = 0;
};

/// Everything the child needs, prepared before the fork. After a fork in a program with several
/// threads even an allocation could wait forever for a lock held by another thread.
struct Preparation {
  std::string program;
  std::vector<std::string> environment;
  std::vector<char*> argv;
  std::vector<char*> envp;
  std::string folder;
  std::optional<cpu_set_t> cpus;
  std::optional<rlimit> memory;
  int output = -1;
  int report = -1;
  pid_t parent = 0;
};

std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

/// The inherited environment with the command's variables first: the first of a name counts.
std::vector<std::string> environment_of(const ChildCommand& command) {
  std::vector<std::string> all = command.environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    bool replaced = false;
    for (const std::string& own : command.environment) {
      replaced = replaced || text.starts_with(own.substr(0, own.find('=') + 1));
    }
    if (!replaced) all.push_back(text);
  }
  return all;
}

[[noreturn]] void fail(const Preparation& child, Step step) {
  const Failure failure{step, errno};
  [[maybe_unused]] const ssize_t written = ::write(child.report, &failure, sizeof(failure));
  ::_exit(127);
}

/// Resets signals to their defaults: exec keeps the mask and ignored signals.
void reset_signals() {
  for (int number = 1; number < NSIG; ++number) ::signal(number, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// Runs in the child: only calls that are safe between fork and exec.
[[noreturn]] void become(const Preparation& child) {
  ::setpgid(0, 0);
  // The parent may have ended before the request took effect.
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || ::getppid() != child.parent) {
    fail(child, Step::kParent);
  }
  reset_signals();
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (::dup2(nothing, STDIN_FILENO) < 0 || ::dup2(child.output, STDOUT_FILENO) < 0 ||
      ::dup2(child.output, STDERR_FILENO) < 0) {
    fail(child, Step::kStreams);
  }
  if (!child.folder.empty() && ::chdir(child.folder.c_str()) != 0) fail(child, Step::kFolder);
  if (child.cpus && ::sched_setaffinity(0, sizeof(cpu_set_t), &*child.cpus) != 0) {
    fail(child, Step::kCpus);
  }
  if (child.memory && ::setrlimit(RLIMIT_AS, &*child.memory) != 0) fail(child, Step::kMemory);
  // Close the inherited descriptors. Kernels before 5.11 lack this call and rely on the flag of
  // each descriptor.
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  ::execve(child.program.c_str(), child.argv.data(), child.envp.data());
  fail(child, Step::kExec);
}

Error error_of(const Failure& failure, const ChildCommand& command) {
  const std::string why = std::generic_category().message(failure.number);
  const auto bad = [&](const std::string& option) {
    return Error{ErrorCode::kInvalidArgument, option + ": " + why};
  };
  switch (failure.step) {
    case Step::kFolder:
      return bad("working_folder = '" + command.working_folder.string() + "'");
    case Step::kCpus:
      return bad("cpus");
    case Step::kMemory:
      return bad("memory_limit_mb = " + std::to_string(command.memory_limit_mb));
    case Step::kExec:
      if (failure.number == ENOEXEC) {
        return Error{ErrorCode::kInvalidArgument,
                     "command[0] = '" + command.arguments[0] +
                         "': is not a program (a script starts with #! and its interpreter)"};
      }
      if (failure.number == ENOENT) {
        return Error{ErrorCode::kNotFound,
                     "command[0] = '" + command.arguments[0] +
                         "': its interpreter (in its #! line) does not exist"};
      }
      return bad("command[0] = '" + command.arguments[0] + "'");
    default:
      return {ErrorCode::kIo, "starting '" + command.arguments[0] + "': " + why};
  }
}

Preparation prepare(const std::filesystem::path& program, const ChildCommand& command) {
  Preparation child;
  child.program = program.string();
  child.environment = environment_of(command);
  child.argv = pointers_to(command.arguments);
  child.envp = pointers_to(child.environment);
  child.folder = command.working_folder.string();
  child.parent = ::getpid();
  if (!command.cpus.empty()) {
    CPU_ZERO(&child.cpus.emplace());
    for (const int cpu : command.cpus) CPU_SET(static_cast<std::size_t>(cpu), &*child.cpus);
  }
  if (command.memory_limit_mb > 0.0) {
    const auto bytes = static_cast<rlim_t>(command.memory_limit_mb * 1e6);
    child.memory = rlimit{bytes, bytes};
  }
  return child;
}

}  // namespace

Result<int> start_child(const std::filesystem::path& program,
                        const ChildCommand& command,
                        int output) {
  Preparation child = prepare(program, command);
  std::array<int, 2> report{};
  if (::pipe2(report.data(), O_CLOEXEC) != 0) {
    return Error{ErrorCode::kIo, "pipe: " + std::generic_category().message(errno)};
  }
  const FileDescriptor reading(report[0]);
  FileDescriptor writing(report[1]);
  child.output = output;
  child.report = writing.get();
  const pid_t pid = ::fork();
  if (pid == 0) become(child);
  if (pid < 0) return Error{ErrorCode::kIo, "fork: " + std::generic_category().message(errno)};
  ::setpgid(pid, pid);  // parent and child both call it; the first takes effect
  writing.close();
  Failure failure;
  ssize_t got = 0;
  do {
    got = ::read(reading.get(), &failure, sizeof(failure));
  } while (got < 0 && errno == EINTR);
  if (got == 0) return static_cast<int>(pid);  // closed by exec
  ::waitpid(pid, nullptr, 0);
  return error_of(failure, command);
}

}  // namespace overfly::process
