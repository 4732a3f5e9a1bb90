// Flight logs over REST: names, uploads and their limits, damaged logs, clients that go away.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/flight/logs/northward_log.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

namespace asio = boost::asio;
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kLogs = "/api/v1/logs";

/// A connection that sends what it likes and may end at any time.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port) : socket_(loop_) {
    socket_.connect({asio::ip::make_address("127.0.0.1"), port});
  }
  void send(const std::string& bytes) { asio::write(socket_, asio::buffer(bytes), failed_); }
  std::string line() {
    asio::read_until(socket_, buffer_, "\r\n", failed_);
    std::string line;
    std::istream stream(&buffer_);
    std::getline(stream, line);
    return line;
  }

 private:
  asio::io_context loop_;
  asio::ip::tcp::socket socket_;
  asio::streambuf buffer_;
  boost::system::error_code failed_;
};

std::string upload_head(const std::string& name, const std::string& more) {
  return "POST /api/v1/logs?name=" + name + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + more + "\r\n";
}

net::ServerLimits small_limits() {
  net::ServerLimits limits;
  limits.uploads.max_bytes = std::uint64_t{1} << 20U;
  limits.uploads.quota_bytes = std::uint64_t{2} << 20U;
  limits.uploads.max_parallel = 2;
  return limits;
}

class LogRoutesTest : public ::testing::Test {
 protected:
  Answer call(const std::string& method, const std::string& target, const std::string& body = "") {
    return ask(server_.port(), method, target, body);
  }
  Answer upload(const std::string& name, const std::string& body) {
    return call("POST", std::string(kLogs) + "?name=" + name, body);
  }
  void write_log(const std::string& name, const std::string& bytes) {
    write_text(server_.folder() / "logs" / name, bytes);
  }
  [[nodiscard]] std::size_t files_of_uploads() const {
    std::error_code none;
    std::size_t files = 0;
    for (fs::directory_iterator entry(server_.folder() / "uploads", none), end; entry != end;
         entry.increment(none)) {
      ++files;
    }
    return files;
  }
  /// Waits for a condition that another thread brings about.
  template <typename Condition>
  static bool comes_true(const Condition& condition) {
    for (int i = 0; i < 3000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  TestServer server_{small_limits()};
};

TEST_F(LogRoutesTest, ListsAndDescribesTheLogsOfTheDataFolders) {
  fs::create_directories(server_.folder() / "logs" / "deep er" / ".hidden");
  write_log("deep er/a%2F.BIN", northward_log());
  write_log("deep er/.hidden/b.bin", northward_log());
  write_log(".c.bin", northward_log());
  write_log("text.bin", "not a log");
  write_log("other.tif", northward_log());
  // Not UTF-8: a single continuation byte, an overlong sequence, a surrogate, one that is cut off.
  for (const char* name : {"\xFF.bin", "\xC0\xAF.bin", "\xED\xA0\x80.bin", "\xE2\x82.bin"}) {
    write_log(name, northward_log());
  }
  const json list = call("GET", kLogs).json();
  ASSERT_EQ(list.at("logs").size(), 1U) << list;
  const json& entry = list.at("logs").at(0);
  EXPECT_EQ(entry.at("name"), "logs/deep er/a%2F.BIN");
  EXPECT_EQ(entry.at("format"), "dataflash");
  EXPECT_EQ(entry.at("size_bytes"), northward_log().size());
  EXPECT_EQ(entry.at("uploaded"), false);
  const std::string log = std::string(kLogs) + "/logs%2Fdeep%20er%2Fa%252F.BIN";
  const json info = call("GET", log).json();
  EXPECT_EQ(info.at("name"), entry.at("name"));
  EXPECT_EQ(info.at("events").at(0).at("kind"), "mode");
  EXPECT_EQ(info.at("events").at(0).at("run"), 0);
  EXPECT_EQ(info.at("clock_runs").at(0).at("run"), 0);
  const json series = call("GET", log + "/series").json();
  EXPECT_EQ(series.at("position_count"), 50);
  EXPECT_EQ(series.at("vehicle"), "");
  EXPECT_EQ(series.at("run"), 0);
  EXPECT_EQ(series.at("attitudes").at("roll_deg").at(7), 10.0);
  EXPECT_EQ(series.at("positions").at("lat_deg").at(1), 47.000009);
  EXPECT_NEAR(series.at("speeds").at("ground_speed_m_s").at(0).get<double>(), 25.0, 0.1);
  EXPECT_EQ(call("DELETE", log).status, 403);
  EXPECT_EQ(call("GET", log + "/series?source=GPS").status, 400);
  EXPECT_EQ(call("GET", log + "/series?from_s=nan").status, 400);
  EXPECT_EQ(call("GET", log + "/series?from_s=3&to_s=2").status, 400);
  EXPECT_EQ(call("GET", log + "/series?from_s=100").status, 422);
}

TEST_F(LogRoutesTest, SaysTheSameOfEveryOtherName) {
  const fs::path outside = server_.folder() / "secret.bin";
  write_text(outside, northward_log());
  fs::create_symlink(outside, server_.folder() / "logs" / "link.bin");
  fs::create_directory_symlink(server_.folder(), server_.folder() / "logs" / "door");
  ASSERT_EQ(::mkfifo((server_.folder() / "logs" / "fifo.bin").c_str(), 0600), 0);
  write_log(".upload-1", northward_log());
  EXPECT_TRUE(call("GET", kLogs).json().at("logs").empty());
  for (const char* name : {"logs%2Flink.bin",
                           "logs%2Fdoor%2Fsecret.bin",
                           "logs%2F..%2Fsecret.bin",
                           "logs%2F.%2Flink.bin",
                           "logs%2F%2Fetc%2Fa.bin",
                           "logs%2Ffifo.bin",
                           "logs%2F.upload-1",
                           "logs%2Fnone.bin",
                           "logs%2F",
                           "logs",
                           "uploads%2Fnone.bin",
                           "%2Fetc%2Fpasswd",
                           "..%2Fsecret.bin",
                           "nowhere%2Fa.bin"}) {
    for (const char* rest : {"", "/series"}) {
      const Answer answer = call("GET", std::string(kLogs) + "/" + name + rest);
      EXPECT_EQ(answer.status, 404) << name << answer.body;
      EXPECT_THAT(answer.body, HasSubstr("no such log")) << name;
    }
    EXPECT_EQ(call("DELETE", std::string(kLogs) + "/" + name).status, 404) << name;
  }
  EXPECT_EQ(call("GET", std::string(kLogs) + "/logs%2Fa%00.bin").status, 400);
  EXPECT_TRUE(fs::exists(outside));
}

TEST_F(LogRoutesTest, TakesUploadsOnlyUnderPlainNames) {
  for (const char* name : {"",
                           "a.txt",
                           ".bin",
                           ".hidden.bin",
                           "..%2Fa.bin",
                           "b%2Fa.bin",
                           "%2Ftmp%2Fa.bin",
                           "a%20b.bin",
                           "a%0A.bin",
                           "m.json"}) {
    const Answer answer = upload(name, northward_log());
    EXPECT_EQ(answer.status, 400) << name << answer.body;
    EXPECT_THAT(answer.body, HasSubstr("must be letters, digits"));
  }
  EXPECT_EQ(upload(std::string(300, 'a') + ".bin", northward_log()).status, 400);
  EXPECT_EQ(call("POST", std::string(kLogs) + "?file=a.bin", northward_log()).status, 400);
  EXPECT_EQ(files_of_uploads(), 0U);
  EXPECT_EQ(upload("a.bin", northward_log()).status, 201);
  EXPECT_EQ(upload("a.bin", northward_log()).status, 409);
  EXPECT_EQ(files_of_uploads(), 1U);
}

TEST_F(LogRoutesTest, LeavesNothingOfWhatIsNoLog) {
  const Answer answer = upload("a.bin", std::string(5000, 'x'));
  EXPECT_EQ(answer.status, 422);
  EXPECT_THAT(answer.json().at("error").at("message").get<std::string>(),
              ::testing::StartsWith("a.bin: is not a flight log"));
  EXPECT_EQ(upload("a.bin", "").status, 422);
  EXPECT_EQ(files_of_uploads(), 0U);
}

TEST_F(LogRoutesTest, LimitsOneUploadAndAllTogether) {
  std::string log = northward_log();
  log.resize(std::size_t{1} << 20U, '\0');
  EXPECT_EQ(upload("large.bin", log + "x").status, 413);
  // The length is not announced: noticed while it comes.
  const std::string head = upload_head("chunked.bin", "Transfer-Encoding: chunked\r\n");
  const std::string chunk = "100000\r\n" + log + "\r\n";
  EXPECT_THAT(exchange_raw(server_.port(), head + chunk + chunk + "0\r\n\r\n"),
              HasSubstr("HTTP/1.1 413"));
  EXPECT_THAT(
      exchange_raw(server_.port(), upload_head("huge.bin", "Content-Length: 1000000000000000\r\n")),
      HasSubstr("HTTP/1.1 413"));
  EXPECT_EQ(files_of_uploads(), 0U);
  EXPECT_THAT(exchange_raw(server_.port(), head + chunk + "0\r\n\r\n"), HasSubstr("HTTP/1.1 201"));
  EXPECT_EQ(upload("second.bin", log).status, 201);
  const Answer full = upload("third.bin", northward_log());
  EXPECT_EQ(full.status, 507);
  EXPECT_THAT(full.body, HasSubstr("--upload-quota"));
  const json uploads = call("GET", kLogs).json().at("uploads");
  EXPECT_EQ(uploads.at("used_bytes"), 2U << 20U);
  EXPECT_EQ(uploads.at("quota_bytes"), 2U << 20U);
  EXPECT_EQ(call("DELETE", std::string(kLogs) + "/uploads%2Fsecond.bin").status, 204);
  EXPECT_EQ(upload("third.bin", northward_log()).status, 201);
}

TEST_F(LogRoutesTest, RemovesUploadsWhoseClientsGoAway) {
  {
    RawClient first(server_.port());
    RawClient second(server_.port());
    for (RawClient* client : {&first, &second}) {
      const std::string name = client == &first ? "a.bin" : "b.bin";
      client->send(upload_head(name, "Content-Length: 900000\r\nExpect: 100-continue\r\n"));
      EXPECT_THAT(client->line(), HasSubstr("100 Continue"));
      client->send(northward_log());
    }
    EXPECT_TRUE(comes_true([&] { return files_of_uploads() == 2; }));
    EXPECT_EQ(call("GET", kLogs).json().at("uploads").at("used_bytes"), 1'800'000);
    EXPECT_EQ(upload("c.bin", northward_log()).status, 503);
  }
  EXPECT_TRUE(comes_true([&] { return files_of_uploads() == 0; }));
  EXPECT_EQ(call("GET", kLogs).json().at("uploads").at("used_bytes"), 0);
  EXPECT_EQ(upload("c.bin", northward_log()).status, 201);
}

TEST_F(LogRoutesTest, TakesUploadsWhoseNameIsEncoded) {
  EXPECT_EQ(call("POST", "/api/v1/%6Cogs?name=a.bin", northward_log()).status, 201);
}

TEST_F(LogRoutesTest, LeavesTheUploadsOfOtherServers) {
  RawClient client(server_.port());
  const std::string log = northward_log();
  client.send(upload_head(
      "a.bin", "Content-Length: " + std::to_string(log.size()) + "\r\nExpect: 100-continue\r\n"));
  EXPECT_THAT(client.line(), HasSubstr("100 Continue"));
  ASSERT_TRUE(comes_true([&] { return files_of_uploads() == 1; }));
  // What a server left that was killed, with the number of this process.
  const fs::path left =
      server_.folder() / "uploads" / (".upload-" + std::to_string(::getpid()) + "-77");
  write_text(left, "x");
  const server::LogUploads other(server_.folder() / "uploads", small_limits().uploads);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(files_of_uploads(), 1U);
  client.send(log);
  EXPECT_THAT(client.line(), ::testing::Eq("\r"));
  EXPECT_THAT(client.line(), HasSubstr("201"));
}

class SlowUploadTest : public ::testing::Test {
 protected:
  /// Sends a log in `pieces` pieces, half a second apart. @return the first line of the answer
  static std::string answer_to_slow_upload(const net::ServerLimits& limits, std::size_t pieces) {
    TestServer server(limits);
    RawClient client(server.port());
    const std::string log = northward_log();
    client.send(upload_head(
        "a.bin", "Content-Length: " + std::to_string(log.size()) + "\r\nExpect: 100-continue\r\n"));
    EXPECT_THAT(client.line(), HasSubstr("100 Continue"));
    (void)client.line();
    const std::size_t step = log.size() / pieces + 1;
    for (std::size_t at = 0; at < log.size(); at += step) {
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      client.send(log.substr(at, step));
    }
    return client.line();
  }
};

TEST_F(SlowUploadTest, IsReceivedAsLongAsBytesArrive) {
  net::ServerLimits limits = small_limits();
  limits.idle_ms = 4'000;
  EXPECT_THAT(answer_to_slow_upload(limits, 9), HasSubstr("201"));
}

TEST_F(SlowUploadTest, IsRefusedBelowTheLeastMeanRate) {
  net::ServerLimits limits = small_limits();
  limits.upload_grace_ms = 0;
  limits.min_upload_bytes_per_s = std::uint64_t{1} << 50U;
  EXPECT_THAT(answer_to_slow_upload(limits, 2), HasSubstr("408"));
}

TEST_F(LogRoutesTest, KeepsTheConnectionAfterAnUpload) {
  const std::string log = northward_log();
  const std::string length = "Content-Length: " + std::to_string(log.size()) + "\r\n";
  const std::string answers = exchange_raw(
      server_.port(),
      upload_head("a.bin", length) + log + upload_head("b.bin", length) + log +
          "GET /api/v1/health HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(answers, HasSubstr("uploads/a.bin"));
  EXPECT_THAT(answers, HasSubstr("uploads/b.bin"));
  EXPECT_THAT(answers, HasSubstr("\"status\":\"ok\""));
}

TEST_F(LogRoutesTest, ReadsWhatIsLeftOfDamagedLogs) {
  std::string log = northward_log();
  const std::string whole = log;
  log.resize(log.size() - 10);
  for (std::size_t i = 600; i < 650; ++i) log[i] = static_cast<char>(i);
  write_log("a.bin", log);
  const std::string target = std::string(kLogs) + "/logs%2Fa.bin";
  const Answer info = call("GET", target);
  EXPECT_EQ(info.status, 200) << info.body;
  EXPECT_FALSE(info.json().at("warnings").empty());
  EXPECT_LT(call("GET", target + "/series").json().at("position_count"), 50);
  // A file that changes is read again.
  write_log("a.bin", whole);
  EXPECT_TRUE(call("GET", target).json().at("warnings").empty());
  EXPECT_EQ(call("GET", target + "/series").json().at("position_count"), 50);
  write_log("a.bin", whole.substr(0, 290));
  EXPECT_EQ(call("GET", target + "/series").status, 422);
}

/// A log whose reading takes many minutes: a hole of 4 TB.
class EndlessLogTest : public LogRoutesTest {
 protected:
  void SetUp() override {
    write_log("endless.bin", northward_log());
    std::error_code failed;
    fs::resize_file(server_.folder() / "logs" / "endless.bin", std::uintmax_t{1} << 42U, failed);
    if (failed) GTEST_SKIP() << "the file system has no files of 4 TB: " << failed.message();
    write_log("small.bin", northward_log());
  }
  void ask_for(RawClient& client) {
    client.send("GET /api/v1/logs/logs%2Fendless.bin HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  }
};

TEST_F(EndlessLogTest, EndsTheReadingWhenTheClientGoes) {
  for (int round = 0; round < 2; ++round) {
    std::array<RawClient, 3> clients{
        RawClient(server_.port()), RawClient(server_.port()), RawClient(server_.port())};
    for (RawClient& client : clients) ask_for(client);
    // Other requests do not wait behind the readers.
    EXPECT_EQ(call("GET", kLogs).status, 200);
  }
  EXPECT_EQ(call("GET", std::string(kLogs) + "/logs%2Fsmall.bin").status, 200);
}

TEST_F(EndlessLogTest, LimitsWhatWaits) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 40; ++i) {
    clients.push_back(std::make_unique<RawClient>(server_.port()));
    ask_for(*clients.back());
  }
  EXPECT_TRUE(comes_true(
      [&] { return call("GET", std::string(kLogs) + "/logs%2Fsmall.bin").status == 503; }));
  // The server ends in spite of them.
}

}  // namespace
}  // namespace overfly::testing
