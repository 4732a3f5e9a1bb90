// Warns of cameras whose images are overexposed: an estimator that fails on them fails for the
// exposure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/scenario/scenario.hpp"

namespace overfly::server {

class SaturationWatch {
 public:
  /// An image is overexposed from this fraction of saturated pixels on. Real scenes with a clipped
  /// sky or a white roof stay below it.
  static constexpr double kMostSaturated = 0.2;

  explicit SaturationWatch(const Scenario& scenario);

  /// Counts one image. @return a warning for the camera's first overexposed image
  std::optional<std::string> add(std::size_t camera,
                                 std::int64_t frame,
                                 double saturated_fraction,
                                 std::int64_t exposure_ns);
  /// One line for each camera with overexposed images, for the end of the log.
  [[nodiscard]] std::vector<std::string> report() const;

 private:
  struct Count {
    std::int64_t images = 0;
    std::int64_t overexposed = 0;
  };
  const Scenario& scenario_;
  std::vector<Count> counts_;  ///< by camera
};

}  // namespace overfly::server
