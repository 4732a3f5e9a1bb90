// The result of `overfly track` as text.
#pragma once

#include <optional>
#include <string>

#include "evaluation/evaluation.hpp"
#include "server/dataset/track_dataset.hpp"

namespace overfly::app {

/// @param out  the trajectory's file
[[nodiscard]] std::string track_summary(const server::Dataset& dataset,
                                        const server::TrackedDataset& tracked,
                                        const std::optional<evaluation::Score>& score,
                                        const std::string& out);

}  // namespace overfly::app
