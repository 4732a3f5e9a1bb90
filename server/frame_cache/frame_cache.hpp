// Rendered pictures kept for other flights: found by their keys, added in the background.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "renderer/renderer.hpp"
#include "server/frame_cache/frame_codec.hpp"
#include "server/frame_cache/frame_folder.hpp"

namespace overfly::server {

/// What a flight has taken from its cache and given to it.
struct FrameCacheUse {
  std::uint64_t read = 0;      ///< pictures that were not rendered
  std::uint64_t rendered = 0;  ///< pictures that the cache did not have, or had damaged
  std::uint64_t added = 0;
  /// Rendered pictures that were not added: the queue was full, or there was no room.
  std::uint64_t passed_over = 0;
  std::uint64_t damaged = 0;  ///< or could not be read
  std::string problem;        ///< the first one; empty = none
};

/// {"read", "rendered", "added", "passed_over", "damaged", "problem"}; no problem: without that
/// field.
[[nodiscard]] nlohmann::json json_from(const FrameCacheUse& use);

/// No flight fails because of it: after an error of the file system it adds nothing more, and says
/// so once. For one thread, in addition to its own.
class FrameCache {
 public:
  /// @param warn  called at most twice, by the thread that uses the cache; may be empty
  FrameCache(FrameFolderOptions options, std::function<void(const std::string&)> warn);
  ~FrameCache();  ///< as finish
  FrameCache(const FrameCache&) = delete;
  FrameCache& operator=(const FrameCache&) = delete;

  /// The picture of a request; empty if there is none.
  [[nodiscard]] std::optional<renderer::CameraFrame> find(const std::string& key,
                                                          const renderer::CameraRequest& request);
  /// Adds a picture that find() did not find. Does not wait: if the disk is slower than the flight,
  /// pictures are passed over.
  void add(const std::string& key, const renderer::CameraFrame& frame);
  /// Waits until what was added is written.
  void finish();
  [[nodiscard]] FrameCacheUse use() const;

 private:
  struct Waiting {
    std::string key;
    renderer::CameraFrame frame;
    std::size_t bytes = 0;
  };

  void write_pictures();
  /// @pre the mutex is locked
  void note_problem(const std::string& text, const std::string& consequence);
  /// @pre the mutex is locked
  void end_adding(const Error& error);
  /// Tells what has gone wrong since the last call.
  void report();

  FrameFolder folder_;
  std::function<void(const std::string&)> warn_;
  FrameCodec reading_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> queue_;
  std::size_t queued_bytes_ = 0;  ///< including the picture that is being written
  bool adds_ = false;             ///< false: the cache is only read
  bool finished_ = false;
  FrameCacheUse use_;
  std::deque<std::string> unreported_;
  std::thread thread_;  ///< last: it uses all others
};

}  // namespace overfly::server
