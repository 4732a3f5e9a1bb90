// The options of commands that fly scenarios: where rendered pictures are kept for other flights.
#pragma once

#include <filesystem>
#include <string>

#include "server/experiments/pictures/flight_frame_cache.hpp"

namespace CLI {
class App;
}

namespace overfly::app {

/// Limit of --frame-cache-gib, and what it is for series of flights.
inline constexpr double kMostFrameCacheGib = 1e5;
inline constexpr double kFrameCacheGib = 8.0;

struct FrameCacheArguments {
  std::filesystem::path folder;  ///< empty = in the folder of the series
  double gib = kFrameCacheGib;
};

/// For a command that flies a series of scenarios.
/// @param arguments  must outlive the command
/// @param default_text  what is used without the option
void add_frame_cache_options(
    CLI::App& command,
    FrameCacheArguments& arguments,
    const std::string& default_text = "frame_cache in the folder of --out");

/// The cache of a series that begins now. @param series  its folder
[[nodiscard]] server::experiments::FlightFrameCache frame_cache_from(
    const FrameCacheArguments& arguments, const std::filesystem::path& series);

/// "620 of 930 pictures were read from the frame cache"; empty if there was none.
[[nodiscard]] std::string pictures_text(const server::experiments::PictureCount& count);

}  // namespace overfly::app
