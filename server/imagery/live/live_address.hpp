// Addresses of live cameras as text.
#pragma once

#include <string>
#include <string_view>

#include "core/result.hpp"

namespace overfly::server {

enum class LiveKind {
  kRtsp,  ///< "rtsp://HOST[:PORT]/PATH"
  kHttp,  ///< "http://HOST[:PORT]/PATH": MJPEG or another video over HTTP
  kV4l2,  ///< "v4l2:/dev/videoN"
  kLcm,   ///< "lcm:CHANNEL@URL", URL of the LCM network
  kRos1,  ///< "ros1:TOPIC@URI", URI of the ROS master
};

struct LiveAddress {
  LiveKind kind = LiveKind::kRtsp;
  /// What clients see, and name: the text without user and password. Unique if the texts are.
  std::string name;
  std::string url;    ///< with user and password; of V4L2 the device, of topics the network
  std::string topic;  ///< or channel
};

/// Reads an address. HOST is a numeric address, IPv6 in brackets, or "localhost": nothing in the
/// program asks a name server. @URL and @URI may be omitted: then LCM's usual group, and the master
/// on this machine.
/// @param field  names the address in messages
/// Errors: kInvalidArgument naming field, value and limit; never with a password.
[[nodiscard]] Result<LiveAddress> parse_live_address(std::string_view text,
                                                     const std::string& field);

}  // namespace overfly::server
