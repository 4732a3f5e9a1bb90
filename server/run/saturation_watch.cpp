#include "server/run/saturation_watch.hpp"

#include "core/text/number_text.hpp"
#include "core/text/percent.hpp"

namespace overfly::server {

SaturationWatch::SaturationWatch(const Scenario& scenario)
    : scenario_(scenario), counts_(scenario.cameras.size()) {}

std::optional<std::string> SaturationWatch::add(std::size_t camera,
                                                std::int64_t frame,
                                                double saturated_fraction,
                                                std::int64_t exposure_ns) {
  Count& count = counts_[camera];
  ++count.images;
  if (saturated_fraction <= kMostSaturated || ++count.overexposed > 1) return std::nullopt;
  return scenario_.cameras[camera].name + ": " + percent_text(saturated_fraction) +
         " of the pixels of frame " + std::to_string(frame) + " are saturated (exposure " +
         number_text(static_cast<double>(exposure_ns) * 1e-6) +
         " ms): estimators see little texture. Lower sensor.exposure_ms or sensor.electrons_per_s, "
         "or use sensor.auto_exposure";
}

std::vector<std::string> SaturationWatch::report() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i].overexposed == 0) continue;
    lines.push_back(scenario_.cameras[i].name + ": " + std::to_string(counts_[i].overexposed) +
                    " of " + std::to_string(counts_[i].images) +
                    " images are overexposed (more than " + percent_text(kMostSaturated) +
                    " of their pixels saturated)");
  }
  return lines;
}

}  // namespace overfly::server
