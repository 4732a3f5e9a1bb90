// How well a score separates two kinds of cases.
#pragma once

#include <optional>
#include <vector>

namespace overfly::evaluation {

/// Area under the receiver operating characteristic: the probability that a positive case has a
/// higher score than a negative one, equal scores counting half (Hanley, McNeil 1982, "The meaning
/// and use of the area under a receiver operating characteristic (ROC) curve", Radiology 143(1)).
/// Empty if there is no case of one of the kinds.
/// @param positive, negative  scores of the cases; finite
[[nodiscard]] std::optional<double> roc_area(const std::vector<double>& positive,
                                             std::vector<double> negative);

}  // namespace overfly::evaluation
