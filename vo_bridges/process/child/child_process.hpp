// A child process that is started and stopped with the estimator.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"
#include "vo_bridges/process/child/child_command.hpp"
#include "vo_bridges/process/child/child_output.hpp"
#include "vo_bridges/process/child/private_folder.hpp"
#include "vo_bridges/process/child/process_family.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::process {

/// A running child in its own process group, with its own folder for temporary files (TMPDIR). It
/// is killed when this process ends in any way, and never remains as a zombie. `stop` also ends all
/// processes that it has started. Thread-safe, except that `stop` must be called from one thread.
class ChildProcess {
 public:
  /// `output` receives what the child writes. Errors: kNotFound, kInvalidArgument, kIo, naming the
  /// option.
  static Result<std::unique_ptr<ChildProcess>> start(const ChildCommand& command,
                                                     std::shared_ptr<ChildOutput> output);
  /// Calls stop() if necessary.
  ~ChildProcess();

  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] bool running() const;
  /// Waits until the child ends. @return whether it has ended
  bool wait(std::chrono::milliseconds patience) const;
  /// Kills the child, its process group and all its descendants, including those with their own
  /// session. Collects its exit status and remaining output, and removes its temporary folder.
  void stop();
  /// "exited with code 3", "was killed by signal 9 (Killed)"; empty while it runs.
  [[nodiscard]] std::string how_it_ended() const;
  /// Resource use so far, or in total after the end.
  [[nodiscard]] ResourceUse resource_use() const;

 private:
  explicit ChildProcess(PrivateFolder temporary) : temporary_(std::move(temporary)) {}
  void sample_use() const;
  /// Reads the child's output until `stop`. Runs on the thread that forks the child and must not
  /// end before it: the kernel sends the PR_SET_PDEATHSIG signal when that thread ends, not when
  /// the process ends.
  void pump();
  /// False at the end of the output.
  bool read_output();

  int pid_ = 0;
  ProcessFamily family_;
  std::optional<PrivateFolder> temporary_;
  std::shared_ptr<ChildOutput> output_;
  FileDescriptor output_pipe_;
  FileDescriptor wake_;  // an eventfd
  std::thread thread_;
  std::atomic<bool> stopped_{false};
  mutable std::mutex mutex_;
  mutable ResourceUse use_;
  mutable std::string end_;
};

}  // namespace overfly::process
