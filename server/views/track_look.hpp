// How the tracks of a run look in a scene.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>

namespace overfly::server {

using TrackRgb = std::array<float, 3>;  ///< in [0, 1]

/// Colour of the truth, and of an estimate by its index.
inline constexpr TrackRgb kTruthRgb = {0.90F, 0.15F, 0.15F};
[[nodiscard]] TrackRgb estimator_rgb(std::size_t index);

/// The truth has the empty name.
struct TrackLook {
  std::size_t first_colour = 0;  ///< index of the first estimator's colour
  std::set<std::string> hidden{};
  std::map<std::string, TrackRgb> colours{};  ///< in place of the usual ones

  [[nodiscard]] bool shows(const std::string& name) const { return !hidden.contains(name); }
  [[nodiscard]] TrackRgb truth_rgb() const;
  /// @param index  of the estimator in its run
  [[nodiscard]] TrackRgb rgb_of(const std::string& name, std::size_t index) const;
  bool operator==(const TrackLook&) const = default;
};

}  // namespace overfly::server
