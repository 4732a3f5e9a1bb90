#include "middleware/lcm/flight_publisher.hpp"

#include <map>
#include <utility>

#include "middleware/lcm/messages.hpp"
#include "middleware/lcm/node.hpp"
#include "middleware/lcm/sensor_messages.hpp"

namespace overfly::lcm {
namespace {

class LcmFlightPublisher final : public FlightPublisher {
 public:
  explicit LcmFlightPublisher(std::shared_ptr<Node> node) : node_(std::move(node)) {}

  Status publish_pose(std::int64_t frame, std::int64_t t_ns, const Pose& T_world_camera) override {
    return publish_message(*node_,
                           std::string(kFlightPrefix) + "TRUTH",
                           truth_message(frame, t_ns, t_ns, T_world_camera));
  }
  Status publish_samples(const SensorSamples& samples) override {
    return with_each_message(samples,
                             [&](const char* name, std::int64_t /*available_ns*/, auto message) {
                               const std::string channel = std::string(kFlightPrefix) + name;
                               message.sequence = ++sequences_[channel];
                               return publish_message(*node_, channel, message);
                             });
  }

 private:
  std::shared_ptr<Node> node_;
  std::map<std::string, std::int64_t> sequences_;
};

}  // namespace

Result<std::unique_ptr<FlightPublisher>> FlightPublisher::open(const std::string& url,
                                                               const std::atomic<bool>* cancel) {
  const Result<Url> parsed = parse_url(url);
  if (!parsed) return parsed.error();
  const auto mode = parsed->options.find("mode");
  if (parsed->provider == "file" && (mode == parsed->options.end() || mode->second != "w")) {
    return Error{ErrorCode::kInvalidArgument,
                 "LCM URL " + url + ": must have the option mode=w: the log is written"};
  }
  auto node = Node::open(*parsed, cancel);
  if (!node) return node.error();
  return std::unique_ptr<FlightPublisher>(std::make_unique<LcmFlightPublisher>(std::move(*node)));
}

}  // namespace overfly::lcm
