// The paper's course as a sequence of bank angles. Private to flight.
#pragma once

#include "flight/bank_profile.hpp"
#include "flight/flight.hpp"

namespace overfly::flight {

/// Plans a straight leg, a right turn through 180 deg, and right-left swings until `length_m` is
/// flown. The swings are centred on the return heading. Their amplitude is chosen so that the
/// flight ends next to its start, within 30 to 100 deg to each side.
///
/// The bank of turn and swings is `bank_max_rad`. It is smaller if the turn would be tighter than
/// kTurnRadiusMinM (slow flight) or if the roll rate could not reverse it within 45 deg of heading.
/// @pre parameters are within their limits
[[nodiscard]] BankProfile plan_course(const CourseParameters& parameters);

}  // namespace overfly::flight
