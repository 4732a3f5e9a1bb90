// Calls the ROS master over XML-RPC with a deadline. The calls of roscpp wait forever for a missing
// master.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::ros1 {

/// Address of an XML-RPC server.
struct XmlRpcAddress {
  std::string host;
  int port = 0;

  bool operator==(const XmlRpcAddress&) const = default;
  [[nodiscard]] std::string uri() const { return "http://" + host + ":" + std::to_string(port); }
  /// True for 127.x.x.x, ::1 and localhost.
  [[nodiscard]] bool is_loopback() const;
};

/// Parses "http://HOST:PORT" with an optional trailing slash.
/// Errors: kInvalidArgument naming the text.
[[nodiscard]] Result<XmlRpcAddress> parse_xml_rpc_address(const std::string& uri);

/// Calls a method of the ROS master or slave interface and returns the value of the answer [code,
/// message, value].
/// @param cancel  may be null; set to true to end the call as if it had timed out
/// Errors: kNotFound if there is no answer in time; kIo if the answer reports a failure or has
/// another form.
[[nodiscard]] Result<XmlRpc::XmlRpcValue> call_xml_rpc(const XmlRpcAddress& address,
                                                       const std::string& method,
                                                       const std::vector<std::string>& arguments,
                                                       std::chrono::nanoseconds timeout,
                                                       const std::atomic<bool>* cancel = nullptr);

/// The process id of a node or of the master. Distinguishes a restarted process from the previous
/// one.
/// Errors: as call_xml_rpc.
[[nodiscard]] Result<int> ask_pid(const XmlRpcAddress& node,
                                  std::chrono::nanoseconds timeout,
                                  const std::atomic<bool>* cancel = nullptr);

/// Reports the publishers of a topic to a node, as the master does. Errors: as call_xml_rpc.
[[nodiscard]] Status tell_publishers(const XmlRpcAddress& node,
                                     const std::string& topic,
                                     const XmlRpc::XmlRpcValue& publishers,
                                     std::chrono::nanoseconds timeout);

}  // namespace overfly::ros1
