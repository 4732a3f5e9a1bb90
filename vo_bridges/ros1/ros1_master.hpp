// The ROS master, asked over XML-RPC with a deadline: roscpp's own calls wait for ever for a master
// that is not there.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::ros1 {

/// Where an XML-RPC server listens.
struct XmlRpcAddress {
  std::string host;
  int port = 0;

  bool operator==(const XmlRpcAddress&) const = default;
  [[nodiscard]] std::string uri() const { return "http://" + host + ":" + std::to_string(port); }
  /// True for 127.x.x.x, ::1 and localhost.
  [[nodiscard]] bool is_loopback() const;
};

/// Reads "http://HOST:PORT" with an optional slash.
/// Errors: kInvalidArgument naming the text.
[[nodiscard]] Result<XmlRpcAddress> parse_xml_rpc_address(const std::string& uri);

/// Calls a method of the ROS master or slave interface and gives back the value of its answer
/// [code, message, value].
/// @param cancel  may be null; when it turns true, the call ends as if the time were up
/// Errors: kNotFound when nobody answers in time; kIo for an answer that says it failed, or none of
/// that form.
[[nodiscard]] Result<XmlRpc::XmlRpcValue> call_xml_rpc(const XmlRpcAddress& address,
                                                       const std::string& method,
                                                       const std::vector<std::string>& arguments,
                                                       std::chrono::nanoseconds timeout,
                                                       const std::atomic<bool>* cancel = nullptr);

/// The process id of a node, or of the master, where it tells a restarted one from the one before.
/// Errors: as call_xml_rpc's.
[[nodiscard]] Result<int> ask_pid(const XmlRpcAddress& node,
                                  std::chrono::nanoseconds timeout,
                                  const std::atomic<bool>* cancel = nullptr);

/// Tells a node who publishes a topic, as the master does. Errors: as call_xml_rpc's.
[[nodiscard]] Status tell_publishers(const XmlRpcAddress& node,
                                     const std::string& topic,
                                     const XmlRpc::XmlRpcValue& publishers,
                                     std::chrono::nanoseconds timeout);

}  // namespace overfly::ros1
