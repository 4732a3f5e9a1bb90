#include "vo_bridges/process/link/figure_intake.hpp"

#include <cmath>
#include <utility>

namespace overfly::process {

bool FigureIntake::takes_counter(std::string_view name, double value) {
  return takes("counter", &counters_, name, value);
}

bool FigureIntake::takes_timing(std::string_view name, double value) {
  return takes("timing_ms", &timings_, name, value);
}

std::vector<std::string> FigureIntake::take_notes() { return std::exchange(notes_, {}); }

bool FigureIntake::takes(const char* kind, Names* names, std::string_view name, double value) {
  const std::string named = std::string(kind) + " " + std::string(name);
  if (!std::isfinite(value)) {
    if (!std::exchange(not_finite_noted_, true)) {
      notes_.push_back("warning: " + named +
                       " is not finite: this and later such values are ignored");
    }
    return false;
  }
  if (names->known.contains(name)) return true;
  if (names->known.size() < kNameLimit) {
    names->known.emplace(name);
    return true;
  }
  if (!std::exchange(names->overflow_noted, true)) {
    notes_.push_back("warning: " + named + " exceeds the limit of " + std::to_string(kNameLimit) +
                     " names in a session: this and later new names are ignored");
  }
  return false;
}

}  // namespace overfly::process
