// Opens the worlds of runs on threads of its own, so that pictures of other worlds do not wait.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "server/timing/thread_priority.hpp"

namespace overfly::terrain {
struct World;
}

namespace overfly::server {

/// Used on one thread, and its functions are called on others.
class WorldOpener {
 public:
  using World = std::shared_ptr<const terrain::World>;
  struct Functions {
    /// Opens a run's world; `cancelled` is to be asked now and then.
    std::function<Result<World>(const std::string& run_id, const std::function<bool()>& cancelled)>
        open;
    /// Called when a world has been opened, or could not be.
    std::function<void()> opened;
    /// Of a thread that begins to open a world.
    std::function<ThreadPriority()> priority;
  };

  /// Worlds opened at the same time.
  static constexpr std::size_t kMaxThreads = 3;

  explicit WorldOpener(Functions functions);
  /// Cancels what is being opened and waits for it.
  ~WorldOpener();

  /// The run's world, or why it cannot be opened; each result is handed out once. Empty while it
  /// is being opened, which this call begins unless kMaxThreads others are being opened: ask again
  /// after `opened`.
  [[nodiscard]] std::optional<Result<World>> take(const std::string& run_id);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::server
