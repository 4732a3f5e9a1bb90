#include "server/app/frame_cache_options.hpp"

#include <CLI/CLI.hpp>

#include "core/text/number_text.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::app {

void add_frame_cache_options(CLI::App& command,
                             FrameCacheArguments& arguments,
                             const std::string& default_text) {
  command.add_option(
      "--frame-cache",
      arguments.folder,
      "Folder of rendered pictures for other flights; several commands may share one. "
      "Default: " +
          default_text);
  command
      .add_option("--frame-cache-gib",
                  arguments.gib,
                  "Size of that folder at most [GiB]; 0: every picture is rendered")
      ->check(CLI::Range(0.0, kMostFrameCacheGib))
      ->capture_default_str();
}

server::experiments::FlightFrameCache frame_cache_from(const FrameCacheArguments& arguments,
                                                       const std::filesystem::path& series) {
  namespace experiments = server::experiments;
  const std::filesystem::path folder = arguments.folder.empty()
                                           ? series / experiments::kFrameCacheFolder
                                           : std::filesystem::absolute(arguments.folder);
  return {folder, arguments.gib, server::utc_now_ns()};
}

std::string pictures_text(const server::experiments::PictureCount& count) {
  const std::uint64_t all = count.read + count.rendered;
  if (all == 0) return "";
  return std::to_string(count.read) + " of " + counted(all, "picture") +
         " were read from the frame cache";
}

}  // namespace overfly::app
