// A client of the Foxglove protocol without a socket, and flights for it.
#pragma once

#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "server/net/foxglove/foxglove_viewer.hpp"
#include "tests/server/net/stream/fake_port.hpp"

namespace overfly::testing {

inline constexpr std::int64_t kFoxgloveEpochNs = 1'700'000'000'000'000'000;
inline constexpr std::int64_t kFoxgloveFrameNs = 50'000'000;

/// The aircraft flies east, 1 m a frame; its pose at frame i.
[[nodiscard]] inline Pose foxglove_place(std::int64_t frame) {
  Pose T_world_body;
  T_world_body.translation = {static_cast<double>(frame), 20.0, 100.0};
  return T_world_body;
}

/// Frame i, and the answer of the first estimator, which tracks from frame 2 on.
inline void append_foxglove_frame(std::int64_t frame, server::RunTimeline* timeline) {
  server::FrameRow row;
  row.frame = frame;
  row.t_ns = frame * kFoxgloveFrameNs;
  row.T_world_body = foxglove_place(frame);
  row.T_world_camera = row.T_world_body * Pose{R_body_camera_nadir(), {0.0, 0.0, 0.5}};
  timeline->append_frame(row);
}
inline void append_foxglove_answer(std::int64_t frame, server::RunTimeline* timeline) {
  server::EstimateRow row;
  row.sample.frame = frame;
  row.sample.t_ns = frame * kFoxgloveFrameNs;
  row.latency_ms = 12.0;
  if (frame >= 2) {
    row.sample.state = TrackingState::kTracking;
    row.T_world_body = foxglove_place(frame);
    row.T_world_body->translation.y() += 3.0;
  }
  timeline->append_estimate(0, row);
}

/// A flight with one camera and one estimator, "vo one".
[[nodiscard]] inline std::shared_ptr<server::RunTimeline> foxglove_flight(server::RunStatus status,
                                                                          std::int64_t frames) {
  server::RunInfo info;
  info.id = "run-1";
  info.scenario = "valley";
  info.status = status;
  info.epoch_utc_ns = kFoxgloveEpochNs;
  info.origin = geodetic_from_deg(47.0, 8.0, 500.0);
  auto timeline = std::make_shared<server::RunTimeline>(info, std::vector<std::string>{"vo one"});
  server::RunCamera camera;
  camera.name = "nadir";
  camera.T_body_camera = Pose{R_body_camera_nadir(), {0.0, 0.0, 0.5}};
  timeline->set_cameras({camera});
  for (std::int64_t i = 0; i < frames; ++i) {
    append_foxglove_frame(i, timeline.get());
    append_foxglove_answer(i, timeline.get());
  }
  return timeline;
}

/// A message of a channel.
struct FoxgloveData {
  std::string topic;
  std::int64_t t_ns = 0;  ///< of the run
  std::vector<std::uint8_t> payload;
};

class FoxgloveClientFake {
 public:
  using Json = nlohmann::json;

  explicit FoxgloveClientFake(std::shared_ptr<server::RunTimeline> flight,
                              bool playback_control = false,
                              std::filesystem::path folder = "/absent")
      : viewer_(port, {"run-1", "session", playback_control, [folder](const std::string&) {
                         return Result<std::filesystem::path>(folder);
                       }}) {
    viewer_.greet("c1");
    viewer_.run_opened(std::move(flight), now_ns_);
  }

  void say(const Json& message) { viewer_.take_text(message.dump(), now_ns_); }
  void say(const std::vector<std::uint8_t>& bytes) { viewer_.take_binary(bytes, now_ns_); }
  /// Subscribes to a topic that was advertised; its channel's number is the subscription's.
  void subscribe(const std::string& topic) {
    const auto id = channel(topic);
    say(Json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", id}}}}});
  }
  void set(const std::string& parameter, const Json& value) {
    say(Json{{"op", "setParameters"},
             {"parameters", {{{"name", parameter}, {"value", value}}}},
             {"id", "set"}});
  }
  /// Lets time pass in steps of a frame.
  void wait(std::int64_t frames) {
    for (std::int64_t i = 0; i < frames; ++i) {
      now_ns_ += kFoxgloveFrameNs;
      viewer_.tick(now_ns_);
    }
  }
  /// The last advertised channel of a topic; -1 if there is none.
  [[nodiscard]] std::int64_t channel(const std::string& topic) const {
    std::int64_t found = -1;
    for (const Json& text : texts("advertise")) {
      for (const Json& entry : text.at("channels")) {
        if (entry.at("topic") == topic) found = entry.at("id");
      }
    }
    return found;
  }
  [[nodiscard]] std::vector<Json> texts(const std::string& op) const {
    std::vector<Json> found;
    for (const Json& text : port.texts) {
      if (text.at("op") == op) found.push_back(text);
    }
    return found;
  }
  /// The value of a parameter by the last message about it.
  [[nodiscard]] Json parameter(const std::string& name) const {
    Json value;
    for (const Json& text : texts("parameterValues")) {
      for (const Json& entry : text.at("parameters")) {
        if (entry.at("name") == name) value = entry.at("value");
      }
    }
    return value;
  }
  /// The messages of a topic that was subscribed to by subscribe().
  [[nodiscard]] std::vector<FoxgloveData> data(const std::string& topic) const {
    std::vector<FoxgloveData> found;
    for (const auto& message : port.binaries) {
      if (message.at(0) != 1 || number<std::uint32_t>(message, 1) != channel(topic)) continue;
      const auto utc_ns = static_cast<std::int64_t>(number<std::uint64_t>(message, 5));
      found.push_back({topic, utc_ns - kFoxgloveEpochNs, {message.begin() + 13, message.end()}});
    }
    return found;
  }
  /// The times of the run that were announced.
  [[nodiscard]] std::vector<std::int64_t> times_ns() const {
    std::vector<std::int64_t> times;
    for (const auto& message : port.binaries) {
      if (message.at(0) != 2) continue;
      const auto utc_ns = static_cast<std::int64_t>(number<std::uint64_t>(message, 1));
      times.push_back(utc_ns - kFoxgloveEpochNs);
    }
    return times;
  }
  /// The states of the playback, as bytes.
  [[nodiscard]] std::vector<std::vector<std::uint8_t>> states() const {
    std::vector<std::vector<std::uint8_t>> found;
    for (const auto& message : port.binaries) {
      if (message.at(0) == 5) found.push_back(message);
    }
    return found;
  }
  [[nodiscard]] net::foxglove::FoxgloveViewer& viewer() { return viewer_; }
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }

  template <typename T>
  static T number(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, &bytes.at(at), sizeof(T));
    return value;
  }

  FakePort port;

 private:
  net::foxglove::FoxgloveViewer viewer_;
  std::int64_t now_ns_ = 1'000'000'000;
};

}  // namespace overfly::testing
