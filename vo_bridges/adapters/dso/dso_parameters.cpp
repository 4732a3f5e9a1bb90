// DSO's parameters and the published variants of them.
#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {
namespace {

const char* const kResizes =
    "would silently reduce the frames to 424 x 320, and the run's camera would not be the "
    "scenario's; give its other values (setting_desiredImmatureDensity 600, "
    "setting_desiredPointDensity 800, setting_minFrames 4, setting_maxFrames 6, "
    "setting_maxOptIterations 4), or a smaller camera";

}  // namespace

std::string upstream_name() { return "DSO"; }

const ParameterSet& upstream_parameters() {
  static const ParameterSet set(
      {
          // Photometric mode as in its command line: 0 = known response (here the identity), 1 =
          // unknown, 2 = perfect images.
          {"mode", ParameterKind::kWhole, "1", 0, 2},
          {"linearizeOperation", ParameterKind::kAutoFlag, "auto", 0, 0},
          {"multiThreading", ParameterKind::kAutoFlag, "auto", 0, 0},
          {"restart_after_loss", ParameterKind::kFlag, "true", 0, 0},
          // "auto" is the mode's value: 7, and 3 in mode 2.
          {"setting_minGradHistAdd", ParameterKind::kAutoNumber, "auto", 0, 255},
          {"setting_minGradHistCut", ParameterKind::kNumber, "0.5", 0, 1},
          {"setting_desiredImmatureDensity", ParameterKind::kNumber, "1500", 10, 100000},
          {"setting_desiredPointDensity", ParameterKind::kNumber, "2000", 10, 100000},
          {"setting_minFrames", ParameterKind::kWhole, "5", 2, 100},
          {"setting_maxFrames", ParameterKind::kWhole, "7", 3, 100},
          {"setting_maxOptIterations", ParameterKind::kWhole, "6", 1, 100},
          {"setting_minOptIterations", ParameterKind::kWhole, "1", 1, 100},
          {"setting_kfGlobalWeight", ParameterKind::kNumber, "1", 0, 100},
      },
      {
          {"setting_minGradHistAdd_7", {{"setting_minGradHistAdd", "7"}}, ""},
          {"setting_minGradHistAdd_5", {{"setting_minGradHistAdd", "5"}}, ""},
          // The presets of its command line.
          {"0", {}, ""},
          {"1", {}, ""},
          {"2", {}, kResizes},
          {"3", {}, kResizes},
      });
  return set;
}

}  // namespace overfly_adapters
