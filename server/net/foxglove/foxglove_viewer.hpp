// One client of the Foxglove protocol: answers its messages and sends it a flight
// (docs/FOXGLOVE.md).
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "server/net/foxglove/client_message.hpp"
#include "server/net/foxglove/flight_feed.hpp"
#include "server/net/foxglove/server_message.hpp"
#include "server/net/foxglove/subscriptions.hpp"
#include "server/net/stream/viewer_port.hpp"

namespace overfly::net::foxglove {

class FoxgloveViewer final : public StreamClient {
 public:
  struct Options {
    std::string run_id;             ///< empty = the newest one
    std::string session;            ///< differs from connection to connection
    bool playback_control = false;  ///< the client knows the messages of playback control
    FlightFeed::FolderOf folder_of;
  };

  /// @param port  must outlive the viewer
  FoxgloveViewer(ViewerPort& port, Options options) : port_(port), options_(std::move(options)) {}

  /// Opens the run; what the client sends meanwhile waits.
  void greet(const std::string& connection_name) override;
  void take_text(const std::string& text, std::int64_t now_ns) override;
  void take_binary(std::span<const std::uint8_t> bytes, std::int64_t now_ns) override;
  [[nodiscard]] bool full() const override { return waiting_.size() >= kMostWaiting; }
  void run_opened(Result<std::shared_ptr<server::RunTimeline>> timeline,
                  std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;
  void picture_ready(const PictureTicket& ticket,
                     const Result<server::Picture>& picture,
                     std::int64_t now_ns) override;
  void picture_sent(const PictureTicket& ticket, std::int64_t now_ns) override;
  [[nodiscard]] std::optional<std::int64_t> tick_after_ns() const override;

 private:
  static constexpr std::size_t kMostWaiting = 64;
  struct CommandVisitor;
  void take(Result<Command> command, std::int64_t now_ns);
  void carry_out(const Result<Command>& command, std::int64_t now_ns);
  void refuse(const std::string& what);
  void send_info();
  void subscribe(const Subscribe& command);
  void unsubscribe(const Unsubscribe& command);
  void get_parameters(const GetParameters& command);
  void set_parameters(const SetParameters& command);
  void watch_parameters(const WatchParameters& command);
  void control_playback(const PlaybackControl& command);
  void offer_channels();
  void begin_to_play();
  void send_playback(bool jumped, const std::string& request_id);
  void send_parameter_changes(std::int64_t now_ns);
  [[nodiscard]] bool is_watched(const std::string& parameter) const;

  ViewerPort& port_;
  Options options_;
  bool opening_ = true;
  std::deque<Result<Command>> waiting_;  ///< received while the run is opened
  Subscriptions subscriptions_;
  std::unique_ptr<FlightFeed> feed_;  ///< null until the run is open
  bool controlled_ = false;           ///< playback control is offered
  bool begun_ = false;                ///< the client has subscribed, or steered the playback
  bool epoch_told_ = false;
  std::set<std::string> watched_;  ///< parameters
  bool watches_all_ = false;
  std::map<std::string, nlohmann::json> parameters_sent_;
  std::optional<std::int64_t> parameters_at_ns_;
  std::optional<std::pair<PlaybackStatus, double>> playback_sent_;
};

}  // namespace overfly::net::foxglove
