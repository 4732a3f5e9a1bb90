#include "server/experiments/predict/risk_model.hpp"

namespace overfly::server::predict {

const RiskModel& fitted_model() {
  static const RiskModel model{-3.0,
                               {-1, 4, 0.2, 0.7, 0.05, 0.1, 0.1, 0.3, 1, 1, 0, 0},
                               {1, 1, 0.3, 0.2, 0.05, 0.1, 0.1, 0.2, 1, 1, 0.2, 0.3},
                               {-0.5, -1, 0.5, 0.3, 0, 0.5, 0, 0.5, 0.5, 0.3, 0.3, 0.1}};
  return model;
}

}  // namespace overfly::server::predict
