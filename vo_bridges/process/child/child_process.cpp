#include "vo_bridges/process/child/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <future>
#include <system_error>
#include <utility>

#include "core/barrier.hpp"
#include "vo_bridges/process/child/child_start.hpp"
#include "vo_bridges/process/child/program.hpp"
#include "vo_bridges/process_usage.hpp"

namespace overfly::process {

namespace {

constexpr int kSampleMs = 250;
/// Time that the kernel gets to end killed descendants.
constexpr std::chrono::milliseconds kEndPatience(5000);

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

/// Formats the result of waitid(2).
std::string end_text(int code, int status) {
  if (code == CLD_EXITED) return "exited with code " + std::to_string(status);
  return "was killed by signal " + std::to_string(status) + " (" + ::strsignal(status) + ")";
}

/// Result of waitid(2) without reaping; empty while the process runs.
siginfo_t state_of(int pid) {
  siginfo_t info{};
  ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT);
  return info;
}

}  // namespace

Result<std::unique_ptr<ChildProcess>> ChildProcess::start(const ChildCommand& command,
                                                          std::shared_ptr<ChildOutput> output) {
  const Result<std::filesystem::path> program = find_program(command.arguments.at(0));
  if (!program) return program.error();
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return Error{ErrorCode::kIo, "pipe: " + std::generic_category().message(errno)};
  }
  FileDescriptor reading(ends[0]);
  FileDescriptor writing(ends[1]);
  Result<PrivateFolder> temporary = PrivateFolder::create();
  if (!temporary) return temporary.error();
  std::unique_ptr<ChildProcess> child(new ChildProcess(std::move(*temporary)));
  ChildCommand own = command;
  own.environment.push_back(child->family_.mark());
  own.environment.push_back("TMPDIR=" + child->temporary_->path().string());
  child->output_ = std::move(output);
  ::fcntl(reading.get(), F_SETFL, O_NONBLOCK);
  child->output_pipe_ = std::move(reading);
  child->wake_ = FileDescriptor(::eventfd(0, EFD_CLOEXEC));
  std::promise<Result<int>> started;
  std::future<Result<int>> start_result = started.get_future();
  child->thread_ = std::thread(
      [&own, &program, &writing, started = std::move(started), self = child.get()]() mutable {
        Result<int> pid = guarded([&] { return start_child(*program, own, writing.get()); });
        writing.close();
        const bool runs = pid.ok();
        if (runs) self->pid_ = *pid;
        started.set_value(std::move(pid));  // the borrowed arguments are not used after this
        if (runs) self->pump();
      });
  const Result<int> pid = start_result.get();
  if (!pid) {
    child->thread_.join();
    return pid.error();
  }
  return child;
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) stop();
}

bool ChildProcess::running() const { return !stopped_ && state_of(pid_).si_pid == 0; }

bool ChildProcess::wait(std::chrono::milliseconds patience) const {
  constexpr std::chrono::milliseconds kStep(5);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (running()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kStep);
  }
  return true;
}

void ChildProcess::stop() {
  if (stopped_) return;
  sample_use();
  family_.kill_members(pid_);
  // Kill the group before its leader is reaped: until then no other group can get its number.
  ::kill(-pid_, SIGKILL);
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT) != 0 &&
         errno == EINTR) {
  }
  family_.end(pid_, kEndPatience);
  {
    const std::lock_guard lock(mutex_);
    end_ = end_text(info.si_code, info.si_status);
    stopped_ = true;
    rusage used{};
    int status = 0;
    if (::wait4(pid_, &status, 0, &used) == pid_) {
      use_.cpu_s = std::max(use_.cpu_s, seconds_of(used.ru_utime) + seconds_of(used.ru_stime));
    }
  }
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_.get(), &one, sizeof(one));
  thread_.join();
  temporary_.reset();
}

std::string ChildProcess::how_it_ended() const {
  const std::lock_guard lock(mutex_);
  if (stopped_) return end_;
  const siginfo_t info = state_of(pid_);
  return info.si_pid == 0 ? "" : end_text(info.si_code, info.si_status);
}

void ChildProcess::sample_use() const {
  const std::lock_guard lock(mutex_);
  if (stopped_) return;
  if (const std::optional<ResourceUse> now = usage_of(pid_)) {
    use_.cpu_s = std::max(use_.cpu_s, now->cpu_s);
    use_.peak_memory_mb = std::max(use_.peak_memory_mb, now->peak_memory_mb);
  }
}

ResourceUse ChildProcess::resource_use() const {
  sample_use();
  const std::lock_guard lock(mutex_);
  return use_;
}

bool ChildProcess::read_output() {
  constexpr std::size_t kBytes = 65536;
  std::array<char, kBytes> bytes;
  const ssize_t got = ::read(output_pipe_.get(), bytes.data(), bytes.size());
  if (got > 0) {
    // Out of memory: drop this piece.
    (void)contained(
        [&] {
          output_->add({bytes.data(), static_cast<std::size_t>(got)});
        },
        [](const char*) {});
  }
  return got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR));
}

void ChildProcess::pump() {
  bool open = true;
  auto sampled = std::chrono::steady_clock::now();
  while (!stopped_) {
    std::array<pollfd, 2> files = {pollfd{wake_.get(), POLLIN, 0},
                                   pollfd{open ? output_pipe_.get() : -1, POLLIN, 0}};
    ::poll(files.data(), files.size(), kSampleMs);
    if (files[1].revents != 0 && !read_output()) {
      open = false;
      output_->close();
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - sampled >= std::chrono::milliseconds(kSampleMs)) {
      (void)contained([this] { sample_use(); }, [](const char*) {});
      sampled = now;
    }
  }
  // Read the rest, but not forever: a detached grandchild may keep the pipe open.
  for (int i = 0; open && i < 64; ++i) open = read_output();
  output_->close();
}

}  // namespace overfly::process
