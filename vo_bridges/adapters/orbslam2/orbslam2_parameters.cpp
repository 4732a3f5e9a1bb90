// ORB-SLAM2's parameters, with the values of its KITTI settings (2000 features), and its published
// variants.
#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {

std::string upstream_name() { return "ORB-SLAM2"; }

const ParameterSet& upstream_parameters() {
  static const ParameterSet set(
      {
          {"vocabulary", ParameterKind::kText, OVERFLY_ORB_VOCABULARY, 0, 0},
          {"wait_for_mapping", ParameterKind::kAutoFlag, "auto", 0, 0},
          {"ORBextractor.nFeatures", ParameterKind::kWhole, "2000", 100, 100000},
          {"ORBextractor.scaleFactor", ParameterKind::kNumber, "1.2", 1.01, 4},
          {"ORBextractor.nLevels", ParameterKind::kWhole, "8", 1, 32},
          {"ORBextractor.iniThFAST", ParameterKind::kWhole, "20", 1, 255},
          {"ORBextractor.minThFAST", ParameterKind::kWhole, "7", 1, 255},
      },
      {
          {"minThFAST_7", {{"ORBextractor.minThFAST", "7"}}, ""},
          {"minThFAST_2", {{"ORBextractor.minThFAST", "2"}}, ""},
      });
  return set;
}

}  // namespace overfly_adapters
