// Camera frames whose images are being copied from the GPU.
#pragma once

#include <cstddef>
#include <deque>

#include "core/result.hpp"
#include "renderer/egl/camera_pass.hpp"
#include "renderer/egl/pixel_ring.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::egl {

class CameraQueue {
 public:
  explicit CameraQueue(std::size_t in_flight) : ring_(in_flight), in_flight_(in_flight) {}

  [[nodiscard]] bool full() const { return frames_.size() == in_flight_; }
  /// Starts an image; `frame` holds its metadata. @pre not full. Errors: as CameraPass::draw.
  Status begin(CameraPass& pass, const CameraRequest& request, CameraFrame frame) {
    const Result<bool> in_ring = pass.draw_into(ring_, request, frame);
    if (!in_ring.ok()) return in_ring.error();
    frames_.push_back({std::move(frame), *in_ring});
    return {};
  }
  /// Errors: kConflict if none was begun; kInternal if OpenGL fails.
  Result<CameraFrame> finish() {
    if (frames_.empty()) return Error{ErrorCode::kConflict, "no image was begun"};
    Begun begun = std::move(frames_.front());
    frames_.pop_front();
    if (begun.in_ring) {
      if (Status status = ring_.pop(begun.frame.image); !status) return status.error();
    }
    return std::move(begun.frame);
  }

 private:
  struct Begun {
    CameraFrame frame;
    bool in_ring = false;  // else its image is already in the frame
  };
  PixelRing ring_;
  std::size_t in_flight_;
  std::deque<Begun> frames_;
};

}  // namespace overfly::renderer::egl
