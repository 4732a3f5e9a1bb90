#include "server/net/connection_table.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <list>
#include <memory>
#include <thread>
#include <vector>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::net {
namespace {

using overfly::testing::ask;
using overfly::testing::TestServer;
using overfly::testing::WebSocketClient;
using Phase = ConnectionPhase;

class Table {
 public:
  explicit Table(const ConnectionLimits& limits) : table_(limits) {}
  ConnectionTable::Place& add() {
    const int number = next_++;
    places_.push_back(table_.add([this, number] { closed.push_back(number); }));
    return *places_.back();
  }
  void drop(std::size_t index) { places_.at(index).reset(); }
  [[nodiscard]] std::size_t count(Phase phase) const { return table_.count(phase); }
  [[nodiscard]] bool has_room_for(Phase phase) const { return table_.has_room_for(phase); }
  std::vector<int> closed;

 private:
  ConnectionTable table_;
  std::vector<std::unique_ptr<ConnectionTable::Place>> places_;
  int next_ = 0;
};

TEST(ConnectionTable, ClosesTheOldestStrangerForANewOne) {
  Table table({2, 8, 8});
  ConnectionTable::Place& first = table.add();
  ConnectionTable::Place& second = table.add();
  ASSERT_TRUE(second.enter(Phase::kReceiving));
  table.add();
  EXPECT_TRUE(table.closed.empty());
  table.add();
  EXPECT_EQ(table.closed, std::vector<int>{0});
  // It was asked to end: it is not admitted again, and is not asked twice.
  EXPECT_FALSE(first.enter(Phase::kReceiving));
  table.add();
  EXPECT_EQ(table.closed, (std::vector<int>{0, 2}));
  EXPECT_EQ(table.count(Phase::kStranger), 2U);
  EXPECT_EQ(table.count(Phase::kReceiving), 1U);
}

TEST(ConnectionTable, ClosesTheConnectionThatIsIdleLongest) {
  Table table({8, 2, 8});
  ConnectionTable::Place& first = table.add();
  ConnectionTable::Place& second = table.add();
  ASSERT_TRUE(first.enter(Phase::kIdle));
  ASSERT_TRUE(second.enter(Phase::kIdle));
  ASSERT_TRUE(first.enter(Phase::kReceiving));
  ASSERT_TRUE(first.enter(Phase::kIdle));  // now `second` is idle longer
  ASSERT_TRUE(table.add().enter(Phase::kReceiving));
  EXPECT_EQ(table.closed, std::vector<int>{1});
}

TEST(ConnectionTable, KeepsConnectionsToWhichItOwesAnAnswer) {
  Table table({8, 2, 8});
  ASSERT_TRUE(table.add().enter(Phase::kAnswering));
  ConnectionTable::Place& sending = table.add();
  ASSERT_TRUE(sending.enter(Phase::kSending));
  ASSERT_TRUE(table.add().enter(Phase::kReceiving));
  EXPECT_EQ(table.closed, std::vector<int>{1});
  ConnectionTable::Place& third = table.add();
  ASSERT_TRUE(third.enter(Phase::kAnswering));  // in place of the one that was receiving
  EXPECT_EQ(table.closed, (std::vector<int>{1, 2}));
  EXPECT_FALSE(table.add().enter(Phase::kReceiving));
  table.drop(0);
  EXPECT_TRUE(table.add().enter(Phase::kReceiving));
}

TEST(ConnectionTable, ViewersTakeNoPlaceOfRequests) {
  Table table({8, 1, 2});
  ASSERT_TRUE(table.add().enter(Phase::kViewer));
  ASSERT_TRUE(table.add().enter(Phase::kViewer));
  EXPECT_FALSE(table.add().enter(Phase::kViewer));
  EXPECT_TRUE(table.add().enter(Phase::kReceiving));
  table.drop(0);
  EXPECT_TRUE(table.add().enter(Phase::kViewer));
  EXPECT_TRUE(table.closed.empty());
}

TEST(ConnectionTable, OnlookersLeaveAnEighthOfThePlaces) {
  Table table({20, 1, 16});
  for (int i = 0; i < 14; ++i) ASSERT_TRUE(table.add().enter(Phase::kOnlooker)) << i;
  EXPECT_FALSE(table.has_room_for(Phase::kOnlooker));
  EXPECT_FALSE(table.add().enter(Phase::kOnlooker));
  EXPECT_TRUE(table.has_room_for(Phase::kViewer));
  EXPECT_TRUE(table.add().enter(Phase::kViewer));
  EXPECT_TRUE(table.add().enter(Phase::kViewer));
  EXPECT_FALSE(table.add().enter(Phase::kViewer));
}

/// A connection on which the test sends bytes.
class RawConnection {
 public:
  explicit RawConnection(std::uint16_t port) : socket_(loop_) {
    socket_.connect({boost::asio::ip::make_address("127.0.0.1"), port});
  }
  void send(const std::string& bytes) { boost::asio::write(socket_, boost::asio::buffer(bytes)); }
  /// Reads to the end of a head.
  std::string read_head() {
    std::string head;
    boost::system::error_code error;
    const std::size_t size =
        boost::asio::read_until(socket_, boost::asio::dynamic_buffer(head), "\r\n\r\n", error);
    return head.substr(0, size);
  }
  /// Waits for the server to close the connection, and that long between two reads of 64 KiB.
  /// @return number of bytes until then
  std::size_t read_to_end(std::chrono::milliseconds pause = {}) {
    boost::system::error_code error;
    std::vector<char> bytes(std::size_t{64} << 10U);
    std::size_t count = 0;
    while (!error) {
      count += socket_.read_some(boost::asio::buffer(bytes), error);
      if (pause.count() > 0) std::this_thread::sleep_for(pause);
    }
    return count;
  }

 private:
  boost::asio::io_context loop_;
  boost::asio::ip::tcp::socket socket_;
};

constexpr const char* kHealth = "GET /api/v1/health HTTP/1.1\r\nHost: localhost\r\n\r\n";

TEST(Connections, ThatSayNothingKeepNobodyOut) {
  ServerLimits limits;
  limits.connections = {4, 4, 4};
  limits.header_ms = 600'000;  // the places, not the time, must make room
  limits.idle_ms = 600'000;
  TestServer server(limits);
  std::list<RawConnection> silent;
  for (int i = 0; i < 40; ++i) {
    silent.emplace_back(server.port());
    if (i % 2 == 0) silent.back().send("GET /api/v1/health HTTP/1.1\r\nHost: loc");
    ASSERT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200) << i;
  }
  silent.front().read_to_end();
}

TEST(Connections, ThatAreKeptAliveGoOldestFirst) {
  ServerLimits limits;
  limits.connections = {8, 2, 8};
  limits.idle_ms = 600'000;
  TestServer server(limits);
  std::list<RawConnection> kept;
  for (int i = 0; i < 20; ++i) {
    kept.emplace_back(server.port());
    kept.back().send(kHealth);
    ASSERT_EQ(kept.back().read_head().substr(0, 12), "HTTP/1.1 200") << i;
  }
  kept.front().read_to_end();
  kept.back().send(kHealth);
  EXPECT_EQ(kept.back().read_head().substr(0, 12), "HTTP/1.1 200");
}

/// A large answer takes longer than connections may be idle.
TEST(Connections, ThatReceiveSlowlyReceiveEverything) {
  ServerLimits limits;
  limits.idle_ms = 300;
  TestServer server(limits);
  // More than the buffers of the sockets.
  constexpr std::size_t kBytes = std::size_t{32} << 20U;
  overfly::testing::write_text(server.folder() / "web" / "large.js", std::string(kBytes, 'x'));
  RawConnection slow(server.port());
  slow.send("GET /large.js HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_GT(slow.read_to_end(std::chrono::milliseconds(2)), kBytes);
}

TEST(Connections, ThatReceiveNothingAreClosed) {
  ServerLimits limits;
  limits.idle_ms = 300;
  TestServer server(limits);
  constexpr std::size_t kBytes = std::size_t{32} << 20U;
  overfly::testing::write_text(server.folder() / "web" / "large.js", std::string(kBytes, 'x'));
  RawConnection asleep(server.port());
  asleep.send("GET /large.js HTTP/1.1\r\nHost: localhost\r\n\r\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_LT(asleep.read_to_end(), kBytes);
}

TEST(Connections, ThatSendTheirBodySlowlyKeepNobodyOut) {
  ServerLimits limits;
  limits.connections = {8, 2, 8};
  limits.idle_ms = 600'000;
  TestServer server(limits);
  std::list<RawConnection> slow;
  for (int i = 0; i < 10; ++i) {
    slow.emplace_back(server.port());
    slow.back().send(
        "POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n{");
    ASSERT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200) << i;
  }
}

TEST(Connections, OfViewersHaveALimitOfTheirOwn) {
  ServerLimits limits;
  limits.connections = {8, 2, 3};
  TestServer server(limits);
  std::vector<std::unique_ptr<WebSocketClient>> viewers;
  for (int i = 0; i < 3; ++i) {
    viewers.push_back(std::make_unique<WebSocketClient>(server.port()));
    ASSERT_TRUE(viewers.back()->is_open());
  }
  EXPECT_FALSE(WebSocketClient(server.port()).is_open());
  const auto refused = ask(server.port(), "GET", "/api/v1/stream");
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.json().at("error").at("code"), "too_many_viewers");
  EXPECT_NE(refused.body.find("3 viewers"), std::string::npos);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200);
  viewers.pop_back();
  while (ask(server.port(), "GET", "/api/v1/stream").status == 503) {
  }
  EXPECT_TRUE(WebSocketClient(server.port()).is_open());
}

TEST(Connections, OfAStrangerEndWhenItsRequestDoesNotCome) {
  ServerLimits limits;
  limits.header_ms = 50;
  TestServer server(limits);
  RawConnection silent(server.port());
  silent.read_to_end();
  RawConnection slow(server.port());
  slow.send("GET / HTTP/1.1\r\nHost: ");
  slow.read_to_end();
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200);
}

}  // namespace
}  // namespace overfly::net
