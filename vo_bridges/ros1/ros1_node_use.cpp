#include "vo_bridges/ros1/ros1_node_use.hpp"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <utility>

#include "vo_bridges/process_usage.hpp"

namespace overfly::ros1 {
namespace {

using XmlRpc::XmlRpcValue;

bool is_list(const XmlRpcValue& value, int least) {
  return value.getType() == XmlRpcValue::TypeArray && value.size() >= least;
}

bool is_text(const XmlRpcValue& value) { return value.getType() == XmlRpcValue::TypeString; }

/// Nodes of a topic in [[topic, [node, ...]], ...].
std::set<std::string> nodes_of(XmlRpcValue& topics, const std::string& topic) {
  std::set<std::string> nodes;
  for (int i = 0; is_list(topics, i + 1); ++i) {
    XmlRpcValue& entry = topics[i];
    if (!is_list(entry, 2) || !is_text(entry[0])) continue;
    if (static_cast<std::string>(entry[0]) != topic) continue;
    for (int k = 0; is_list(entry[1], k + 1); ++k) {
      if (is_text(entry[1][k])) nodes.insert(static_cast<std::string>(entry[1][k]));
    }
  }
  return nodes;
}

/// Whether a host is this machine: a socket can then bind to its address.
bool is_here(const XmlRpcAddress& node) {
  if (node.is_loopback()) return true;
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* addresses = nullptr;
  if (getaddrinfo(node.host.c_str(), nullptr, &hints, &addresses) != 0) return false;
  bool here = false;
  for (const addrinfo* a = addresses; a != nullptr && !here; a = a->ai_next) {
    const int handle = socket(a->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (handle < 0) continue;
    here = bind(handle, a->ai_addr, a->ai_addrlen) == 0;
    close(handle);
  }
  freeaddrinfo(addresses);
  return here;
}

}  // namespace

NodeUse::NodeUse(XmlRpcAddress master,
                 std::string own_name,
                 std::string image_topic,
                 std::string pose_topic)
    : master_(std::move(master)),
      own_name_(std::move(own_name)),
      image_topic_(std::move(image_topic)),
      pose_topic_(std::move(pose_topic)) {}

std::optional<int> NodeUse::find(std::chrono::nanoseconds timeout,
                                 const std::atomic<bool>* cancel) const {
  Result<XmlRpcValue> state = call_xml_rpc(master_, "getSystemState", {own_name_}, timeout, cancel);
  if (!state || !is_list(*state, 2)) return std::nullopt;
  const std::set<std::string> publishers = nodes_of((*state)[0], pose_topic_);
  for (const std::string& name : nodes_of((*state)[1], image_topic_)) {
    if (name == own_name_ || !publishers.contains(name)) continue;
    Result<XmlRpcValue> uri =
        call_xml_rpc(master_, "lookupNode", {own_name_, name}, timeout, cancel);
    if (!uri || !is_text(*uri)) continue;
    const auto address = parse_xml_rpc_address(static_cast<std::string>(*uri));
    if (!address || !is_here(*address)) continue;
    if (const Result<int> pid = ask_pid(*address, timeout, cancel); pid) return *pid;
  }
  return std::nullopt;
}

void NodeUse::look(std::chrono::nanoseconds timeout, const std::atomic<bool>* cancel) {
  {
    const std::lock_guard lock(mutex_);
    if (pid_ && usage_of(*pid_)) return;
  }
  const std::optional<int> pid = find(timeout, cancel);
  if (!pid || *pid == getpid()) return;
  const std::optional<ResourceUse> now = usage_of(*pid);
  if (!now) return;
  const std::lock_guard lock(mutex_);
  if (pid_ == pid) return;  // another thread was faster
  earlier_.cpu_s += last_.cpu_s;
  earlier_.peak_memory_mb = std::max(earlier_.peak_memory_mb, last_.peak_memory_mb);
  last_ = {};
  pid_ = pid;
  cpu_before_s_ = now->cpu_s;
}

std::optional<ResourceUse> NodeUse::use() const {
  const std::lock_guard lock(mutex_);
  if (!pid_) return std::nullopt;
  if (const auto now = usage_of(*pid_)) {
    last_ = {now->cpu_s - cpu_before_s_, now->peak_memory_mb};
  }
  return ResourceUse{earlier_.cpu_s + last_.cpu_s,
                     std::max(earlier_.peak_memory_mb, last_.peak_memory_mb)};
}

}  // namespace overfly::ros1
