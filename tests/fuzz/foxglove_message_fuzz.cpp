// Messages of a client of the Foxglove protocol, one a line: a line that begins with '{' as text,
// another one as a binary message. The client watches a small flight, and its messages are carried
// out. The first byte chooses the subprotocol and whether the run flies.
#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "server/net/foxglove/foxglove_viewer.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace {

using overfly::net::PictureTicket;
using overfly::net::foxglove::FoxgloveViewer;
namespace server = overfly::server;

/// A connection that takes everything and draws at once.
class OpenPort final : public overfly::net::ViewerPort {
 public:
  void send_text(std::string text) override { bytes += text.size(); }
  void send_binary(std::vector<std::uint8_t> message) override { bytes += message.size(); }
  void send_picture(const PictureTicket& ticket,
                    std::vector<std::uint8_t> head,
                    std::shared_ptr<const std::vector<std::uint8_t>> jpeg) override {
    bytes += head.size() + jpeg->size();
    sent.push_back(ticket);
  }
  void draw(const PictureTicket& ticket, const server::PictureRequest& request) override {
    drawn.emplace_back(ticket, request.t_ns);
  }
  void open_run(const std::string& /*run_id*/) override {}
  void open_newest_run() override {}
  void work(std::function<std::function<void()>()> slow) override { works.push_back(slow()); }
  [[nodiscard]] std::optional<double> picture_limit_hz() const override { return std::nullopt; }
  [[nodiscard]] std::size_t unsent_bytes() const override { return bytes; }

  std::deque<PictureTicket> sent;
  std::deque<std::pair<PictureTicket, std::int64_t>> drawn;
  std::deque<std::function<void()>> works;
  std::size_t bytes = 0;
};

std::shared_ptr<server::RunTimeline> small_flight(server::RunStatus status) {
  server::RunInfo info;
  info.id = "run";
  info.status = status;
  info.epoch_utc_ns = 1'700'000'000'000'000'000;
  info.origin = overfly::geodetic_from_deg(47.0, 8.0, 500.0);
  info.estimator_cameras = {"nadir", "oblique"};
  auto timeline =
      std::make_shared<server::RunTimeline>(info, std::vector<std::string>{"a b", "a_b"});
  timeline->set_cameras({{"nadir", {}, {}}, {"oblique", {}, {}}});
  for (std::int64_t i = 0; i < 40; ++i) {
    server::FrameRow frame;
    frame.frame = i;
    frame.t_ns = i * 50'000'000;
    for (std::size_t camera = 0; camera < 2; ++camera) timeline->append_frame(frame, camera);
    server::EstimateRow row;
    row.sample.frame = i;
    row.sample.t_ns = frame.t_ns;
    row.sample.state = overfly::TrackingState::kTracking;
    if (i > 5) row.T_world_body = overfly::Pose{};
    timeline->append_estimate(0, row);
    timeline->append_log({frame.t_ns, "warning", "text", "fault", "a b"});
  }
  return timeline;
}

/// What a connection does between two messages.
void serve(FoxgloveViewer* viewer, OpenPort* port, std::int64_t now_ns) {
  static const auto jpeg = std::make_shared<const std::vector<std::uint8_t>>(8, std::uint8_t{1});
  port->bytes = 0;
  viewer->tick(now_ns);
  for (const auto& [ticket, t_ns] : std::exchange(port->drawn, {})) {
    const std::int64_t frame = t_ns / 50'000'000;
    server::Picture picture{frame, t_ns, 4, 2, true, jpeg};
    viewer->picture_ready(ticket, picture, now_ns);
  }
  for (const PictureTicket& ticket : std::exchange(port->sent, {})) {
    viewer->picture_sent(ticket, now_ns);
  }
  for (const auto& then : std::exchange(port->works, {})) then();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto flown = small_flight(server::RunStatus::kCompleted);
  static const auto flying = small_flight(server::RunStatus::kRunning);
  if (size == 0) return 0;
  std::string_view rest = overfly::fuzz::text_of(data, size).substr(1);
  OpenPort port;
  FoxgloveViewer viewer(
      port, {"run", "session", (data[0] & 1U) != 0, [](const std::string&) {
               return overfly::Result<std::filesystem::path>(std::filesystem::path("/absent"));
             }});
  viewer.greet("c1");
  std::int64_t now_ns = 0;
  viewer.run_opened((data[0] & 2U) != 0 ? flying : flown, now_ns);
  while (!rest.empty()) {
    const std::string_view line = overfly::fuzz::take_line(&rest);
    now_ns += 100'000'000;
    if (line.starts_with('{')) {
      viewer.take_text(std::string(line), now_ns);
    } else {
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(line.data());
      viewer.take_binary({bytes, line.size()}, now_ns);
    }
    serve(&viewer, &port, now_ns);
    (void)viewer.tick_after_ns();
  }
  return 0;
}
