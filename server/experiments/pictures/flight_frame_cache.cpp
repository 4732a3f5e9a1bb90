#include "server/experiments/pictures/flight_frame_cache.hpp"

#include <system_error>

#include "core/text/number_text.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::server::experiments {

std::vector<std::string> frame_cache_options(const FlightFrameCache& cache, bool adds) {
  std::error_code ignored;
  if (cache.budget_gib <= 0.0) return {};
  if (!adds && !std::filesystem::exists(cache.folder, ignored)) return {};
  return {"--frame-cache",
          cache.folder.string(),
          "--frame-cache-gib",
          adds ? number_text(cache.budget_gib) : "0",
          "--frame-cache-since-ns",
          std::to_string(cache.since_ns)};
}

void count_pictures(const std::filesystem::path& run, PictureCount& count) {
  const Result<nlohmann::json> timings = read_json(timings_file(run));
  if (!timings || !timings->is_object()) return;
  const auto use = timings->find("frame_cache");
  if (use == timings->end() || !use->is_object()) return;
  const auto number = [&](const char* name) {
    const auto field = use->find(name);
    return field != use->end() && field->is_number_unsigned() ? field->get<std::uint64_t>() : 0;
  };
  count.read += number("read");
  count.rendered += number("rendered");
  const auto problem = use->find("problem");
  if (problem != use->end() && problem->is_string()) count.problem = problem->get<std::string>();
}

}  // namespace overfly::server::experiments
