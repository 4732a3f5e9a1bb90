// The flight of ROS 1 topics as a source of truth.
#pragma once

#include <atomic>
#include <memory>

#include "core/earth/geodesy.hpp"
#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "flight/ros/ros_flight.hpp"

namespace overfly::flight::ros_live {

/// Flies what topics report. Time is that of the messages' headers and counts from the first
/// instant with a position and an attitude; the time of arrival is not used. Positions are
/// interpolated linearly, attitudes by SLERP.
///
/// Messages are read as those of recordings are (logs::decode_ros): world east-north-up, body
/// forward-left-up (REP-103), heights of NavSatFix above the ellipsoid. state_at() waits until the
/// stamps have passed the time. The flight ends at the last sample when a topic's stamps start
/// again or the vehicle is disarmed; warnings() says why. Stamps that start again before the flight
/// begins are waited for again, with a warning. It fails (kIo) after `patience` without a
/// sample.
///
/// What its sensors measure is in sample_source(), as logged_sensors.hpp has it of a recording.
/// @param cancel  ends the wait for the flight's start; may be null
/// Errors: as ros1::TopicListener::open; kIo after `patience`, with what is missing; kCancelled.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_ros(const RosFlight& flight,
                                                           const LocalFrame& frame,
                                                           const std::atomic<bool>* cancel);

}  // namespace overfly::flight::ros_live
