// The ground under a run's tracks, from the world that it flew over.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "server/report/figures/ground_picture.hpp"
#include "server/report/run/report_run.hpp"

namespace overfly::server {
struct OpenedWorld;  // server/worlds/scenario_world.hpp
}

namespace overfly::server::report {

/// Opens the world of the run in a folder.
using OpenRunWorld = std::function<Result<std::shared_ptr<const OpenedWorld>>(
    const std::filesystem::path& run_folder)>;

/// How maps are drawn.
struct MapOptions {
  /// Empty: the world that the run's scenario names is opened, wherever its files are.
  OpenRunWorld open_world{};
  const std::atomic<bool>* cancel = nullptr;  ///< may be null
};

struct MapPicture {
  std::string data_uri;     ///< of a JPEG; empty if there is none
  std::string attribution;  ///< of the imagery
  std::string note;         ///< why there is no picture, or what is to be known about it
};

/// Opens the run's world. A world that is absent or cannot be read gives a note instead of a
/// picture; the built-in world is not made for it.
/// Errors: kCancelled.
[[nodiscard]] Result<MapPicture> map_picture(const ReportRun& run,
                                             const GroundExtent& extent,
                                             int width_px,
                                             int height_px,
                                             const MapOptions& options);

}  // namespace overfly::server::report
