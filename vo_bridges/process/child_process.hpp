// A program of somebody else's, started and ended with us.
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

#include "core/result.hpp"
#include "vo_bridges/process/child_output.hpp"
#include "vo_bridges/process/file_descriptor.hpp"
#include "vo_bridges/process/private_folder.hpp"
#include "vo_bridges/process/process_family.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::process {

struct ChildCommand {
  std::vector<std::string> arguments;    ///< the program first
  std::vector<std::string> environment;  ///< "NAME=VALUE", besides ours
  std::filesystem::path working_folder;  ///< empty = ours
  std::vector<int> cpus;                 ///< empty = all
  double memory_limit_mb = 0.0;          ///< of its address space; 0 = none
};

/// A running child in a process group of its own, with a folder of its own for temporary files
/// (TMPDIR). It dies with this process, however this ends, and never stays as a zombie; `stop` ends
/// all that it has started as well. All methods from any thread, but `stop` from one.
class ChildProcess {
 public:
  /// `output` gets what the child writes. Errors: kNotFound, kInvalidArgument, kIo, naming the
  /// option.
  static Result<std::unique_ptr<ChildProcess>> start(const ChildCommand& command,
                                                     std::shared_ptr<ChildOutput> output);
  /// Stops it, if that is still to be done.
  ~ChildProcess();

  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] bool running() const;
  /// Waits for its end.
  bool wait(std::chrono::milliseconds patience) const;
  /// Kills it, its process group and all its descendants, also those with a session of their own;
  /// takes its exit status and the rest of its output; removes its temporary folder.
  void stop();
  /// "exited with code 3", "was killed by signal 9 (Killed)"; empty while it runs.
  [[nodiscard]] std::string how_it_ended() const;
  /// So far, or at its end.
  [[nodiscard]] ResourceUse resource_use() const;

 private:
  explicit ChildProcess(PrivateFolder temporary) : temporary_(std::move(temporary)) {}
  void sample_use() const;
  /// Reads its output until `stop`. The thread that forked it must live as long as it does: the
  /// kernel sends the signal of PR_SET_PDEATHSIG when that thread ends, not only the process.
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
