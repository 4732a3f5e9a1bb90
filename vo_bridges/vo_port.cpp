#include "vo_bridges/vo_port.hpp"

#include <string>

namespace overfly {

namespace {

bool same_lens(const Distortion& a, const Distortion& b) {
  return a.model == b.model && a.k == b.k;
}

}  // namespace

Status validate_vo_frame(const VoFrame& frame, const VoFrame* previous) {
  const std::string where = "frame " + std::to_string(frame.index);
  const auto bad = [&](const std::string& what) {
    return Error{ErrorCode::kInvalidArgument, where + ": " + what};
  };
  if (!frame.image || frame.image->empty()) return bad("the image is empty");
  if (frame.image->channels != 1) {
    return bad("the image has " + std::to_string(frame.image->channels) +
               " channels: must be 1 (grey)");
  }
  if (Status status = frame.intrinsics.validate(); !status) return status.error().in(where);
  if (frame.image->width_px != frame.intrinsics.width_px ||
      frame.image->height_px != frame.intrinsics.height_px) {
    return bad("the image is " + std::to_string(frame.image->width_px) + " x " +
               std::to_string(frame.image->height_px) + " px, its intrinsics are for " +
               std::to_string(frame.intrinsics.width_px) + " x " +
               std::to_string(frame.intrinsics.height_px) + " px");
  }
  if (previous == nullptr) {
    // Only for the first frame: the check covers the whole lens.
    Status status = CameraModel(frame.intrinsics, frame.distortion).validate();
    return status ? status : status.error().in(where);
  }
  if (frame.index <= previous->index || frame.t_ns <= previous->t_ns) {
    return bad("not after frame " + std::to_string(previous->index));
  }
  if (frame.intrinsics.width_px != previous->intrinsics.width_px ||
      frame.intrinsics.height_px != previous->intrinsics.height_px) {
    return bad("the image size changed in flight");
  }
  const PinholeCamera& now = frame.intrinsics;
  const PinholeCamera& first = previous->intrinsics;
  if (now.fx_px != first.fx_px || now.fy_px != first.fy_px || now.cx_px != first.cx_px ||
      now.cy_px != first.cy_px) {
    return bad("the intrinsics changed in flight");
  }
  if (!same_lens(frame.distortion, previous->distortion)) {
    return bad("the lens distortion changed in flight");
  }
  return {};
}

}  // namespace overfly
