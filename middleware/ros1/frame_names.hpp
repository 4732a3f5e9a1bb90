// Frames of the messages about an aircraft, on topics of ROS and in recordings of them.
#pragma once

namespace overfly::ros1 {

/// East, north, up at the world's origin.
inline constexpr const char* kWorldFrame = "world";
/// The aircraft's body in ROS's axes (REP 103): x forward, y left, z up.
inline constexpr const char* kBodyFrame = "base_link";
/// The range sensor: its x axis is the beam, as sensor_msgs/Range demands; down in kBodyFrame.
inline constexpr const char* kRangeFrame = "range_link";

}  // namespace overfly::ros1
