// Written by tests/flights/predict_fit.py from tests/server/experiments/predict/flights.csv.
// Fitted to 84 flights of 10 s with the native estimator, 61 lost and 23 completed, over the worlds
// land1, land2, land3, land1x5, land2x12, land3x3, board, rows, lake, faint
// (tests/flights/predict_worlds.py). Each value: texels, corners, bare, similarity, relief,
// rotation, translation, overlap, blur, noise, void, sun.
#include "server/experiments/predict/risk_model.hpp"

namespace overfly::server::predict {

const RiskModel& fitted_model() {
  static const RiskModel model{-1.98434,
                               {-0.290776,
                                3.28906,
                                0.517282,
                                3.30227,
                                0.0490697,
                                0.0235835,
                                0.014648,
                                0.262076,
                                0.581999,
                                1.71734,
                                0.0310103,
                                0.136745},
                               {1.41334,
                                2.57414,
                                0.422633,
                                0.900888,
                                0.125158,
                                0.0361579,
                                0.0204873,
                                0.266317,
                                0.573423,
                                0.837128,
                                0.0795108,
                                0.25684},
                               {-0.0437768,
                                -0.1135,
                                0.133213,
                                0.288696,
                                0,
                                0,
                                0.0834078,
                                0.30018,
                                0.0847123,
                                0.00823013,
                                0.277476,
                                0.117775}};
  return model;
}

}  // namespace overfly::server::predict
