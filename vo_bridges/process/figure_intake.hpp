// Counters and timings of an estimator, kept within bounds.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace overfly::process {

/// Says which figures of a session are taken: finite ones, of a bounded number of names. What it
/// leaves out ends no flight; each kind of it is noted once.
class FigureIntake {
 public:
  static constexpr std::size_t kNameLimit = 256;  ///< of counters, and as many of timings

  [[nodiscard]] bool takes_counter(std::string_view name, double value);
  [[nodiscard]] bool takes_timing(std::string_view name, double value);
  /// Lines for the log since the last call.
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
