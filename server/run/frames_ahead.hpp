// How far a lockstep flight makes its frames ahead of the estimators.
#pragma once

#include <cstddef>
#include <cstdint>

#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// A keyframe of `feature` takes as long as the rendering of ten frames. With twice as many frames
/// ahead neither side waits for the other when keyframes follow each other.
inline constexpr std::size_t kMostFramesAhead = 24;
/// Limit of the memory of these frames.
inline constexpr std::uint64_t kFramesAheadBytes = std::uint64_t{32} << 20U;

/// Memory of one frame between the cameras and the record: the images of all cameras, and grey
/// copies of colour ones [bytes].
[[nodiscard]] std::uint64_t frame_bytes(const Scenario& scenario);

/// Number of frames that wait for the estimators in addition to the one that is made while an
/// estimator works; 0 in real time and without estimators.
[[nodiscard]] std::size_t lockstep_frames_ahead(const Scenario& scenario);

}  // namespace overfly::server
