// The paper's course as a sequence of bank angles. Private to flight.
#pragma once

#include "flight/bank_profile.hpp"
#include "flight/flight.hpp"

namespace overfly::flight {

/// A straight leg, a right turn through 180 deg, and right-left swings until `length_m` is flown.
/// The swings are centred on the way back, each as wide as brings the end beside the start, but
/// between 30 and 100 deg to each side.
///
/// The bank of turn and swings is `bank_max_rad`, less where the turn would be tighter than
/// kTurnRadiusMinM (slow flight) or where the roll rate could not reverse it within 45 deg of
/// heading.
/// @pre parameters are within their limits
[[nodiscard]] BankProfile plan_course(const CourseParameters& parameters);

}  // namespace overfly::flight
