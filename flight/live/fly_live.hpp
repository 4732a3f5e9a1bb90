// Opens the flight of a live vehicle: link, preparation, truth.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/earth/geodesy.hpp"
#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "flight/live/live_options.hpp"
#include "flight/mavlink/feedback/feedback_options.hpp"
#include "flight/mavlink/link/link_address.hpp"

namespace overfly::flight::live {

/// How to reach a vehicle and what it has to do before the flight.
struct LiveFlight {
  mavlink::LinkAddress link;
  bool read_only =
      false;  ///< not a byte is sent; all fields below `signing_key_file` must be empty
  std::uint8_t system = 0;  ///< the vehicle's system number; 0: the first autopilot that is heard
  /// If given, only messages signed with this key are accepted, and all that is sent is signed.
  std::optional<std::filesystem::path> signing_key_file;
  double rate_hz = 0.0;  ///< to ask for, of the messages of the truth; 0: as the vehicle sends them
  /// To ask for, of the vehicle's IMU; its other sensors are asked for at up to 20 Hz, the GPS at
  /// up to 10 Hz. 0: all as the vehicle sends them.
  double sensor_rate_hz = 0.0;
  std::map<std::string, double> parameters;           ///< set in the order of their names
  std::optional<std::filesystem::path> mission_file;  ///< replaces the vehicle's mission
  bool arm_and_start = false;                         ///< arms, and starts the mission
  std::optional<mavlink::FeedbackOptions> feedback;   ///< estimates are sent to the vehicle
  LiveTruthOptions truth;
};

/// Where the messages of a vehicle are recorded; empty: nowhere.
struct LiveRecording {
  std::filesystem::path tlog;  ///< must not exist
};

/// Connects to a vehicle, prepares it, and flies what it reports: see LiveTruth.
/// A vehicle must send its first heartbeat within the patience of LiveTruthOptions; arming is tried
/// for a minute.
/// @param cancel  ends every wait; may be null
/// @param recording  gets all messages of the link, from its opening to the end of the flight
/// Errors: as FrameRecorder::create, Vehicle::open, request_message_rate, set_parameter,
/// read_mission_file, upload_mission, arm, start_mission, prepare_feedback and LiveTruth::open;
/// kConflict if the vehicle has not stored the mission as it was sent.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_live(const LiveFlight& flight,
                                                            const LocalFrame& frame,
                                                            const std::atomic<bool>* cancel,
                                                            const LiveRecording& recording = {});

}  // namespace overfly::flight::live
