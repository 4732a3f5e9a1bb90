// Pictures for viewers: camera, debug and scene views of a run at any instant. They are drawn on a
// separate thread, which during a real-time flight gets only the processor time that the flight
// leaves.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/result.hpp"
#include "server/runs/run_manager.hpp"
#include "server/views/picture_request.hpp"

namespace overfly::server {

/// Thread-safe. Keeps one renderer per world in use; the least recently used one is evicted.
class ViewService {
 public:
  explicit ViewService(RunManager& runs);
  /// Waits for the picture in progress; cancels the opening of a world.
  ~ViewService();

  /// Queues a picture for a client's stream. A waiting request of the same (client, stream) is
  /// replaced and its `done` gets kCancelled, so that a slow machine shows newer pictures, not
  /// more. `done` is called on the service's thread.
  /// @param abandoned  true when nobody waits for the picture any more: it is not drawn, and `done`
  ///     gets kCancelled; may be null
  void request(std::uint64_t client,
               int stream,
               const PictureRequest& request,
               PictureDone done,
               std::shared_ptr<const std::atomic<bool>> abandoned = nullptr);
  /// Queues a look at one pixel, likewise.
  void probe(std::uint64_t client,
             int stream,
             const PixelRequest& request,
             PixelDone done,
             std::shared_ptr<const std::atomic<bool>> abandoned = nullptr);
  /// Drops the waiting requests of a client without calling their `done`.
  void forget(std::uint64_t client);
  /// Closes the files of deleted runs, which otherwise keep their disk space. Does not wait.
  void drop_deleted();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::server
