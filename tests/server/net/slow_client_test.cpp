// A client that does not read is disconnected and does not affect others.
#include <gtest/gtest.h>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;

TEST(SlowClient, IsClosedWith4000WhileOthersGoOnAndThenResumes) {
  net::ServerLimits limits;
  limits.max_unsent_bytes = 64 << 10;
  limits.send_buffer_bytes = 8 << 10;
  TestServer server(limits);
  const std::string id = server.fly("tiny");
  WebSocketClient slow(server.port(), {{}, 4 << 10});
  WebSocketClient other(server.port());
  slow.command({{"type", "watch"}, {"run", id}});
  other.command({{"type", "watch"}, {"run", id}});
  // Each of these answers repeats a name of 2 kB: 1 MB that `slow` does not read.
  const std::string name(2000, 'x');
  for (int i = 0; i < 500; ++i) slow.send({{"type", "watch"}, {"run", name}, {"request", i}});
  for (int frame = 0; frame < 20; ++frame) {
    EXPECT_EQ(other.command({{"type", "seek"}, {"frame", frame}}).at("type"), "ok");
  }
  server.wait_for_log("a slow client was disconnected");  // before `slow` reads again
  EXPECT_EQ(slow.read_to_end(), 4000);

  std::size_t rows = 0;
  for (const json& message : slow.texts()) {
    if (message.at("type") == "rows" && message.at("stream") == "truth") {
      rows = message.at("seq").get<std::size_t>() + message.at("columns").at("frame").size();
    }
  }
  WebSocketClient again(server.port());
  again.command({{"type", "watch"}, {"run", id}, {"resume", {{"truth", rows}}}});
  again.wait_for("playback");
  for (const json& message : again.texts()) {
    if (message.at("type") != "rows" || message.at("stream") != "truth") continue;
    EXPECT_EQ(message.at("seq"), rows);
    rows += message.at("columns").at("frame").size();
  }
  EXPECT_EQ(rows, 63U);
}

TEST(SlowClient, GetsOnePictureAtATimeAndThenTheNewest) {
  net::ServerLimits limits;
  limits.send_buffer_bytes = 4 << 10;
  TestServer server(limits);
  const std::string id = server.start("slow");
  WebSocketClient slow(server.port(), {{}, 4 << 10});
  WebSocketClient witness(server.port());
  slow.command(
      {{"type", "subscribe"}, {"pictures", {{{"run", id}, {"name", "scene"}, {"quality", 100}}}}});
#if defined(__SANITIZE_THREAD__)  // which makes drawing ten times slower
  const int height_px = 720;
#else
  const int height_px = 1440;
#endif
  slow.command({{"type", "view"}, {"width_px", 4 * height_px / 3}, {"height_px", height_px}});
  slow.command({{"type", "watch"}, {"run", id}});
  witness.command({{"type", "watch"}, {"run", id}});
  const auto frame_at_least = [](std::int64_t frame) {
    return [frame](const json& message) {
      return message.at("type") == "playback" && run_in(message).at("frame") >= frame;
    };
  };
  // `slow` takes a first picture, then nothing for 30 frames of the run.
  slow.wait_for_picture([](const PictureMessage&) { return true; });
  const std::int64_t before = run_in(witness.wait_until(frame_at_least(0))).at("frame");
  const std::int64_t later = run_in(witness.wait_until(frame_at_least(before + 30))).at("frame");
  const std::size_t stale = slow.pictures().size();
  slow.wait_for_picture(
      [&](const PictureMessage& picture) { return picture.header.frame >= later; });
  // On their way meanwhile: one being written, what the kernel holds, and one drawn after it.
  EXPECT_LE(slow.pictures().size() - stale, 4U);
  ASSERT_EQ(ask(server.port(), "POST", "/api/v1/runs/" + id + "/cancel").status, 202);
}

}  // namespace
}  // namespace overfly::testing
