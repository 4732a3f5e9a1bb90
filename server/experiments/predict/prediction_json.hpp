// A prediction as JSON (docs/PREDICT.md).
#pragma once

#include <nlohmann/json.hpp>

#include "server/experiments/predict/prediction.hpp"

namespace overfly::server::predict {

[[nodiscard]] nlohmann::json json_from(const Prediction& prediction);

}  // namespace overfly::server::predict
