// A fault of a camera or of the satellite receiver, as the scenario describes it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "sensor/image_faults.hpp"

namespace overfly::server {

enum class FaultKind {
  kDroppedFrames,    ///< images that never reach the estimators
  kFrozenFrame,      ///< the last image repeated, with new stamps
  kSaturationBurst,  ///< light on the lens: a flash, the sun
  kDirt,
  kWaterDrop,
  kBlackout,
  kStampJitter,  ///< random jitter of the stamps given to estimators
  kStampOffset,  ///< constant offset of the stamps given to estimators
  kGpsOutage,    ///< the satellite receiver has no fix
};

/// "dropped_frames", "frozen_frame", "saturation_burst", ...
[[nodiscard]] const char* to_string(FaultKind kind);
[[nodiscard]] std::optional<FaultKind> fault_kind_from(const std::string& text);

/// Active for frames stamped, and satellite fixes measured, in [at_ns, end_ns).
struct FaultSpec {
  FaultKind kind = FaultKind::kBlackout;
  std::int64_t at_ns = 0;
  std::int64_t end_ns = std::numeric_limits<std::int64_t>::max();
  std::optional<std::size_t> camera;  ///< index; empty = all
  std::int64_t every = 1;             ///< kDroppedFrames: the first frame and every n-th after it
  std::optional<double> probability;  ///< kDroppedFrames: per frame, instead of `every`
  double sigma_ns = 0.0;              ///< kStampJitter
  std::int64_t offset_ns = 0;         ///< kStampOffset
  sensor::ImageFault image;           ///< for faults on the lens
  std::uint64_t seed = 1;

  [[nodiscard]] bool in_force(std::size_t of_camera, std::int64_t t_ns) const {
    return t_ns >= at_ns && t_ns < end_ns && camera.value_or(of_camera) == of_camera;
  }
  /// True for faults that change the light on the lens.
  [[nodiscard]] bool on_lens() const;
};

}  // namespace overfly::server
