#include "middleware/ros1/master.hpp"

#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcDispatch.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <charconv>
#include <limits>

#include "core/cancellable_wait.hpp"

namespace overfly::ros1 {
namespace {

using Clock = std::chrono::steady_clock;

/// The third element of [1, message, value].
/// Errors: kIo.
Result<XmlRpc::XmlRpcValue> value_of_answer(XmlRpc::XmlRpcValue& answer, const std::string& what) {
  using XmlRpc::XmlRpcValue;
  if (answer.getType() != XmlRpcValue::TypeArray || answer.size() != 3 ||
      answer[0].getType() != XmlRpcValue::TypeInt ||
      answer[1].getType() != XmlRpcValue::TypeString) {
    return Error{ErrorCode::kIo, what + ": not a valid answer of a ROS master or node"};
  }
  if (static_cast<int>(answer[0]) != 1) {
    return Error{ErrorCode::kIo, what + ": " + static_cast<std::string>(answer[1])};
  }
  return answer[2];
}

/// Errors: as call_xml_rpc.
Result<XmlRpc::XmlRpcValue> call(const XmlRpcAddress& address,
                                 const std::string& method,
                                 const XmlRpc::XmlRpcValue& values,
                                 std::chrono::nanoseconds timeout,
                                 const std::atomic<bool>* cancel = nullptr) {
  const std::string what = address.uri() + " " + method;
  const Clock::time_point end = Clock::now() + timeout;
  XmlRpc::XmlRpcValue answer;
  bool done = false;
  try {
    XmlRpc::XmlRpcClient client(address.host.c_str(), address.port, "/");
    if (client.executeNonBlock(method.c_str(), values)) {
      XmlRpc::XmlRpcDispatch dispatch;
      dispatch.addSource(&client,
                         XmlRpc::XmlRpcDispatch::WritableEvent | XmlRpc::XmlRpcDispatch::Exception);
      // Also true for a lost connection: then there is no answer.
      const bool over = wait_unless_cancelled(cancel, end, [&](std::chrono::nanoseconds left) {
        dispatch.work(std::chrono::duration<double>(left).count());
        return client.executeCheckDone(answer);
      });
      dispatch.removeSource(&client);
      done = over && answer.valid() && !client.isFault();
    }
    client.close();
    if (done) return value_of_answer(answer, what);
  } catch (const XmlRpc::XmlRpcException& failure) {
    return Error{ErrorCode::kIo, what + ": " + failure.getMessage()};
  }
  return Error{ErrorCode::kNotFound, what + ": no answer"};
}

}  // namespace

bool XmlRpcAddress::is_loopback() const {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

Result<XmlRpcAddress> parse_xml_rpc_address(const std::string& uri) {
  const auto bad = [&] {
    return Error{ErrorCode::kInvalidArgument, "'" + uri + "': must be http://HOST:PORT"};
  };
  constexpr std::string_view kScheme = "http://";
  std::string_view rest = uri;
  if (!rest.starts_with(kScheme)) return bad();
  rest.remove_prefix(kScheme.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return bad();
  XmlRpcAddress address;
  address.host = rest.substr(0, colon);
  if (address.host.find_first_of("/ @?#") != std::string::npos) return bad();
  const std::string_view port = rest.substr(colon + 1);
  const auto [end, failure] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  const bool whole = failure == std::errc() && end == port.data() + port.size();
  if (!whole || address.port < 1 || address.port > std::numeric_limits<std::uint16_t>::max()) {
    return bad();
  }
  return address;
}

Result<XmlRpc::XmlRpcValue> call_xml_rpc(const XmlRpcAddress& address,
                                         const std::string& method,
                                         const std::vector<std::string>& arguments,
                                         std::chrono::nanoseconds timeout,
                                         const std::atomic<bool>* cancel) {
  XmlRpc::XmlRpcValue values;
  for (std::size_t i = 0; i < arguments.size(); ++i) values[static_cast<int>(i)] = arguments[i];
  return call(address, method, values, timeout, cancel);
}

Result<int> ask_pid(const XmlRpcAddress& node,
                    std::chrono::nanoseconds timeout,
                    const std::atomic<bool>* cancel) {
  Result<XmlRpc::XmlRpcValue> pid = call_xml_rpc(node, "getPid", {"/overfly"}, timeout, cancel);
  if (!pid) return pid.error();
  if (pid->getType() != XmlRpc::XmlRpcValue::TypeInt) {
    return Error{ErrorCode::kIo, node.uri() + " getPid: the answer is not a number"};
  }
  return static_cast<int>(*pid);
}

Status tell_publishers(const XmlRpcAddress& node,
                       const std::string& topic,
                       const XmlRpc::XmlRpcValue& publishers,
                       std::chrono::nanoseconds timeout) {
  XmlRpc::XmlRpcValue values;
  values[0] = "/master";
  values[1] = topic;
  values[2] = publishers;
  const Result<XmlRpc::XmlRpcValue> answer = call(node, "publisherUpdate", values, timeout);
  return answer ? Status() : Status(answer.error());
}

}  // namespace overfly::ros1
