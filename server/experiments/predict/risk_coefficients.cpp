// Written by tests/flights/predict_fit.py from tests/server/experiments/predict/flights.csv.
// Fitted to 168 flights of 10 s with the native estimator, 112 lost and 56 completed, over the
// worlds land1, land2, land3, land1x5, land2x12, land3x3, board, rows, lake, faint
// (tests/flights/predict_worlds.py). Each value: texels, corners, bare, similarity, relief,
// rotation, translation, overlap, blur, noise, void, sun.
#include "server/experiments/predict/risk_model.hpp"

namespace overfly::server::predict {

const RiskModel& fitted_model() {
  static const RiskModel model{-2.28367,
                               {-0.251841,
                                3.32277,
                                0.525948,
                                3.32471,
                                0.0519571,
                                0.0212457,
                                0.0135189,
                                0.240685,
                                0.476383,
                                1.73582,
                                0.0293669,
                                0.130094},
                               {1.36551,
                                2.67167,
                                0.420104,
                                0.88775,
                                0.13711,
                                0.0323746,
                                0.0176718,
                                0.259308,
                                0.529865,
                                0.855842,
                                0.074363,
                                0.256572},
                               {0,
                                -0.272751,
                                0.197239,
                                0.239396,
                                0,
                                0.0441844,
                                0.124093,
                                0.274392,
                                0.107049,
                                0.0598351,
                                0.181069,
                                0.0490126}};
  return model;
}

}  // namespace overfly::server::predict
