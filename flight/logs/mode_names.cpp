#include "flight/logs/mode_names.hpp"

#include <array>

namespace overfly::flight::logs {
namespace {

/// By number (ArduPlane's Mode::Number); 9 is not used.
constexpr std::array kPlaneModes = {
    "MANUAL",  "CIRCLE",          "STABILIZE",  "TRAINING", "ACRO",         "FBWA",
    "FBWB",    "CRUISE",          "AUTOTUNE",   "",         "AUTO",         "RTL",
    "LOITER",  "TAKEOFF",         "AVOID_ADSB", "GUIDED",   "INITIALISING", "QSTABILIZE",
    "QHOVER",  "QLOITER",         "QLAND",      "QRTL",     "QAUTOTUNE",    "QACRO",
    "THERMAL", "LOITER_ALT_QLAND"};

}  // namespace

std::string mode_text(std::int64_t mode, bool is_ardu_plane) {
  std::string text = "mode " + std::to_string(mode);
  if (!is_ardu_plane || mode < 0 || mode >= static_cast<std::int64_t>(kPlaneModes.size())) {
    return text;
  }
  const std::string name = kPlaneModes[static_cast<std::size_t>(mode)];
  return name.empty() ? text : text + " (" + name + ")";
}

}  // namespace overfly::flight::logs
