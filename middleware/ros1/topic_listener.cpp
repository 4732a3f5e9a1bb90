#include "middleware/ros1/topic_listener.hpp"

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <utility>

#include "core/barrier.hpp"
#include "middleware/ros1/line_log.hpp"
#include "middleware/ros1/master_watch.hpp"
#include "middleware/ros1/node.hpp"

namespace overfly::ros1 {

/// A message of any type, as it was sent.
template <std::size_t kMostBytes>
struct RawMessage {
  std::vector<std::uint8_t> bytes;
  bool too_large = false;
};

}  // namespace overfly::ros1

// NOLINTBEGIN(readability-identifier-naming): names required by ROS
namespace ros {
namespace message_traits {

template <std::size_t kMostBytes>
struct IsMessage<overfly::ros1::RawMessage<kMostBytes>> : TrueType {};

/// "*" makes roscpp accept every publisher.
template <std::size_t kMostBytes>
struct MD5Sum<overfly::ros1::RawMessage<kMostBytes>> {
  static const char* value() { return "*"; }
  static const char* value(const overfly::ros1::RawMessage<kMostBytes>& /*message*/) { return "*"; }
};
template <std::size_t kMostBytes>
struct DataType<overfly::ros1::RawMessage<kMostBytes>> {
  static const char* value() { return "*"; }
  static const char* value(const overfly::ros1::RawMessage<kMostBytes>& /*message*/) { return "*"; }
};

}  // namespace message_traits

namespace serialization {

template <std::size_t kMostBytes>
struct Serializer<overfly::ros1::RawMessage<kMostBytes>> {
  template <typename Stream>
  static void read(Stream& stream, overfly::ros1::RawMessage<kMostBytes>& message) {
    const std::uint32_t size = stream.getLength();
    message.too_large = size > kMostBytes;
    const std::uint8_t* const from = stream.advance(size);
    if (!message.too_large) message.bytes.assign(from, from + size);
  }
};

}  // namespace serialization
}  // namespace ros
// NOLINTEND(readability-identifier-naming)

namespace overfly::ros1 {
namespace {

/// Messages of one topic that wait for the listener's thread; the oldest are dropped.
constexpr std::uint32_t kMostWaiting = 20'000;
constexpr std::uint32_t kMostWaitingImages = 2;

template <std::size_t kMost, std::uint32_t kWaiting>
class RosTopicListener final : public TopicListener {
 public:
  explicit RosTopicListener(Take take) : take_(std::move(take)), spinner_(1, &queue_) {
    handle_.setCallbackQueue(&queue_);
  }
  ~RosTopicListener() override {
    watch_.reset();
    for (ros::Subscriber& subscriber : subscribers_) subscriber.shutdown();
    spinner_.stop();
    queue_.disable();
  }

  Status subscribe(const Node& node, const std::vector<std::string>& topics) {
    spinner_.start();
    topics_ = topics;
    std::vector<TopicRegistration> registrations;
    for (const std::string& topic : topics_) {
      try {
        ros::SubscribeOptions options;
        options.initByFullCallbackType<const Event&>(
            topic, kWaiting, [this, &topic](const Event& event) {
              // ROS has no exception barrier; without memory the message is dropped.
              (void)contained([&] { pass_on(topic, event); }, [](const char*) {});
            });
        options.transport_hints = ros::TransportHints().tcpNoDelay();
        subscribers_.push_back(handle_.subscribe(options));
      } catch (const std::exception& failure) {
        return Error{ErrorCode::kInvalidArgument, "topic " + topic + ": " + failure.what()};
      }
      registrations.push_back({subscribers_.back().getTopic(), "*", false});
    }
    const auto nothing = [](const std::atomic<bool>& /*cancel*/) {};
    watch_ = std::make_unique<MasterWatch>(
        node.master(), node.name(), std::move(registrations), log_, nothing);
    return {};
  }

  [[nodiscard]] std::string publishers() const override {
    std::string text;
    for (const ros::Subscriber& subscriber : subscribers_) {
      const std::uint32_t count = subscriber.getNumPublishers();
      text += (text.empty() ? "" : ", ") + subscriber.getTopic() + " has " + std::to_string(count) +
              (count == 1 ? " publisher" : " publishers");
    }
    if (!watch_->master_answers()) text += "; the ROS master does not answer";
    if (!Node::alive()) text += "; the ROS node of this process was shut down";
    return text;
  }
  [[nodiscard]] std::uint64_t too_large() const override { return too_large_; }

 private:
  using Event = ros::MessageEvent<const RawMessage<kMost>>;

  void pass_on(const std::string& topic, const Event& event) {
    const auto message = event.getConstMessage();
    if (!message || message->too_large) {
      ++too_large_;
      return;
    }
    const ros::M_string& header = event.getConnectionHeader();
    const auto type = header.find("type");
    take_({topic, type != header.end() ? type->second : std::string(), message->bytes});
  }

  Take take_;
  std::vector<std::string> topics_;
  std::atomic<std::uint64_t> too_large_{0};
  std::shared_ptr<LineLog> log_ = std::make_shared<LineLog>();
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  ros::AsyncSpinner spinner_;
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<MasterWatch> watch_;
};

template <typename Listener>
Result<std::unique_ptr<TopicListener>> listening(const Node& node,
                                                 const TopicListenerOptions& options,
                                                 TopicListener::Take take) {
  auto listener = std::make_unique<Listener>(std::move(take));
  if (Status status = listener->subscribe(node, options.topics); !status) return status.error();
  return std::unique_ptr<TopicListener>(std::move(listener));
}

}  // namespace

Result<std::unique_ptr<TopicListener>> TopicListener::open(const TopicListenerOptions& options,
                                                           Take take,
                                                           const std::atomic<bool>* cancel) {
  const auto master = parse_xml_rpc_address(options.master_uri);
  if (!master) return master.error();
  const Result<Node*> node = Node::join(*master, options.node_name, options.patience, cancel);
  if (!node) return node.error();
  if (options.images) {
    return listening<RosTopicListener<TopicListener::kMostImageBytes, kMostWaitingImages>>(
        **node, options, std::move(take));
  }
  return listening<RosTopicListener<TopicListener::kMostBytes, kMostWaiting>>(
      **node, options, std::move(take));
}

}  // namespace overfly::ros1
