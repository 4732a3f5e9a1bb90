// The kinds of sources of a calibration session's images.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "calibration/board.hpp"
#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "server/calibration/session/board_images.hpp"
#include "server/imagery/live/live_address.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server {

/// Images of a session may have this many pixels.
inline constexpr std::int64_t kMostBoardImagePixels = 40'000'000;

/// Files of a folder, each checked by the server's rules already.
[[nodiscard]] std::unique_ptr<BoardImages> folder_images(std::vector<std::filesystem::path> files);

/// A log with images, or a video; at most ten images a second of it.
/// @param topic   or channel; may be empty, see LoggedImages
/// @param cancel  must outlive the images, here and below
/// Errors: as open_image_source.
[[nodiscard]] Result<std::unique_ptr<BoardImages>> recording_images(
    const std::filesystem::path& file,
    const std::string& topic,
    const SourcePolicy& sources,
    const std::atomic<bool>* cancel);

/// A virtual board in front of a scenario's camera, drawn image by image (calibrate_virtual).
/// Errors: kInvalidArgument if the board fits nowhere into the image.
[[nodiscard]] Result<std::unique_ptr<BoardImages>> virtual_images(const CameraSpec& camera,
                                                                  const calibration::Board& board,
                                                                  int views,
                                                                  std::uint64_t seed);

/// Errors: as open_live_images.
[[nodiscard]] Result<std::unique_ptr<BoardImages>> camera_images(const LiveAddress& address,
                                                                 const std::atomic<bool>* cancel);

/// Files that a client sends one by one. push() and finish() are thread-safe.
class UploadedImages final : public BoardImages {
 public:
  static constexpr std::size_t kMostWaiting = 4;

  /// @param file  a PNG or JPEG file
  /// Errors: kConflict while kMostWaiting images wait, and after finish().
  [[nodiscard]] Status push(std::string name, std::vector<std::uint8_t> file);
  void finish();

  [[nodiscard]] Result<std::optional<BoardImage>> next(std::chrono::milliseconds patience) override;
  [[nodiscard]] bool ended() const override;

 private:
  struct File {
    std::string name;
    std::vector<std::uint8_t> bytes;
  };
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<File> files_;
  bool finished_ = false;
};

}  // namespace overfly::server
