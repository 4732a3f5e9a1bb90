// Reads bags of ROS 1 (.bag, .bag.active), format 2.0.
#pragma once

#include <cstdint>
#include <span>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/logs/log_sink.hpp"
#include "flight/logs/ros/message_sink.hpp"

namespace overfly::flight::logs {

/// Whether the first bytes of a file are those of a bag of format 2.0.
[[nodiscard]] bool is_rosbag(std::span<const std::uint8_t> head);

/// Reads a bag once, from start to end, with or without an index at its end.
///
/// A stream is a topic. Chunks may be compressed with lz4 or bz2. The chunk that a recorder was
/// writing when it ended has no length yet: it is read up to the last whole message. What was left
/// out is reported in warnings.
/// Errors: kIo; kUnsupported if the bag is encrypted; kCancelled if the sink stops.
[[nodiscard]] Status read_rosbag(ForwardReader& file, LogSink& sink);

/// As read_rosbag, with the messages for another receiver: `sink` gets warnings and progress only.
[[nodiscard]] Status read_rosbag_messages(ForwardReader& file,
                                          LogSink& sink,
                                          RosMessageSink& messages);

}  // namespace overfly::flight::logs
