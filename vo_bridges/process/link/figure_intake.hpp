// Limits the counters and timings of an estimator.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace overfly::process {

/// Decides which figures of a session are accepted: finite values, and a bounded number of names.
/// Other figures are dropped without ending the flight; each kind is noted once.
class FigureIntake {
 public:
  static constexpr std::size_t kNameLimit = 256;  ///< for counters, and the same for timings

  [[nodiscard]] bool takes_counter(std::string_view name, double value);
  [[nodiscard]] bool takes_timing(std::string_view name, double value);
  /// Log lines since the last call.
  [[nodiscard]] std::vector<std::string> take_notes();

 private:
  struct Names {
    std::set<std::string, std::less<>> known;
    bool overflow_noted = false;
  };

  [[nodiscard]] bool takes(const char* kind, Names* names, std::string_view name, double value);

  Names counters_;
  Names timings_;
  bool not_finite_noted_ = false;
  std::vector<std::string> notes_;
};

}  // namespace overfly::process
