// Images of a virtual board as a source of calibration sessions.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "calibration/board.hpp"
#include "server/calibration/session/board_images.hpp"
#include "server/calibration/virtual_camera.hpp"

namespace overfly::server::testing {

inline constexpr calibration::Board kSessionBoard{9, 6, 0.03};

inline CameraModel session_camera() {
  return CameraModel(PinholeCamera{480, 360, 340.0, 338.5, 242.0, 177.0},
                     {DistortionModel::kRadtan, {-0.2, 0.05, 0.0005, -0.0004, 0.0}});
}

/// @param count  at least 4 are drawn
inline std::vector<Image> board_images(int count) {
  auto camera =
      VirtualCamera::create({session_camera(), {}, std::max(count, 4), 1}, kSessionBoard).value();
  std::vector<Image> images;
  for (int i = 0; i < count; ++i) images.push_back(camera.image(static_cast<std::size_t>(i)));
  return images;
}

class ListedImages final : public BoardImages {
 public:
  struct Behaviour {
    std::size_t fails_after = 1'000'000;
    bool moving = false;
    bool repeat = false;  ///< without end
  };
  ListedImages(std::vector<Image> images, Behaviour behaviour)
      : images_(std::move(images)), behaviour_(behaviour) {}

  [[nodiscard]] Result<std::optional<BoardImage>> next(std::chrono::milliseconds) override {
    if (next_ >= behaviour_.fails_after) return Error{ErrorCode::kIo, "the cable was pulled"};
    const std::size_t index = behaviour_.repeat ? next_ % images_.size() : next_;
    ++next_;
    return std::optional(BoardImage{"image " + std::to_string(next_), images_.at(index)});
  }
  [[nodiscard]] bool ended() const override {
    return !behaviour_.repeat && next_ >= images_.size();
  }
  [[nodiscard]] std::optional<std::size_t> total() const override {
    return behaviour_.repeat ? std::nullopt : std::optional(images_.size());
  }
  [[nodiscard]] bool moving() const override { return behaviour_.moving; }

 private:
  std::vector<Image> images_;
  Behaviour behaviour_;
  std::size_t next_ = 0;
};

}  // namespace overfly::server::testing
