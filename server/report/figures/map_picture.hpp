// The ground under a run's tracks, from the world that it flew over.
#pragma once

#include <atomic>
#include <string>

#include "core/result.hpp"
#include "server/report/figures/ground_picture.hpp"
#include "server/report/run/report_run.hpp"

namespace overfly::server::report {

struct MapPicture {
  std::string data_uri;     ///< of a JPEG; empty if there is none
  std::string attribution;  ///< of the imagery
  std::string note;         ///< why there is no picture, or what is to be known about it
};

/// Opens the run's world. A world that is absent or cannot be read gives a note instead of a
/// picture; the built-in world is not made for it.
/// @param cancel  may be null
/// Errors: kCancelled.
[[nodiscard]] Result<MapPicture> map_picture(const ReportRun& run,
                                             const GroundExtent& extent,
                                             int width_px,
                                             int height_px,
                                             const std::atomic<bool>* cancel);

}  // namespace overfly::server::report
