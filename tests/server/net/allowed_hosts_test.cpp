#include "server/net/http/allowed_hosts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::net {
namespace {

using overfly::testing::ask;
using overfly::testing::exchange_raw;
using overfly::testing::TestServer;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kLocal = "192.168.7.5";

TEST(AllowedHosts, ReadsHostAndPort) {
  EXPECT_EQ(parse_authority("Fly.example.org:8480", 80), (Authority{"fly.example.org", 8480}));
  EXPECT_EQ(parse_authority("localhost", 80), (Authority{"localhost", 80}));
  EXPECT_EQ(parse_authority("[0:0::1]:9000", 80), (Authority{"::1", 9000}));
  EXPECT_EQ(parse_authority("[::1]", 443), (Authority{"::1", 443}));
  for (const char* text : {"",
                           ":8480",
                           "localhost:",
                           "localhost:x",
                           "localhost:99999",
                           "localhost:80:80",
                           "localhost ",
                           "user@localhost",
                           "localhost/path",
                           "localhost#",
                           "::1",
                           "[::1",
                           "[localhost]",
                           "[::1]x",
                           "loc\xC3\xA4lhost"}) {
    EXPECT_FALSE(parse_authority(text, 80)) << text;
  }
}

TEST(AllowedHosts, AllowsLoopbackTheLocalEndTheMachineAndTheNamesGiven) {
  const AllowedHosts hosts({"Fly.example.org", "10.0.0.9", "FD00::9"});
  for (const char* host : {"localhost",
                           "a.localhost",
                           "127.0.0.1",
                           "127.9.9.9",
                           "::1",
                           "fly.example.org",
                           "10.0.0.9",
                           "fd00::9",
                           kLocal}) {
    EXPECT_TRUE(hosts.allows(host, kLocal)) << host;
  }
  EXPECT_TRUE(hosts.allows("192.168.7.5", "::ffff:192.168.7.5"));
  std::array<char, 256> name{};
  ASSERT_EQ(::gethostname(name.data(), name.size() - 1), 0);
  const auto machine = parse_authority(name.data(), 80);
  ASSERT_TRUE(machine);
  EXPECT_TRUE(hosts.allows(machine->host, kLocal));
}

TEST(AllowedHosts, RefusesEveryOtherName) {
  const AllowedHosts hosts({"fly.example.org"});
  for (const char* host : {"evil.example",
                           "192.168.7.6",
                           "127.0.0.1.evil.example",
                           "127.evil",
                           "localhost.evil.example",
                           "evilfly.example.org",
                           "a.fly.example.org",
                           ""}) {
    EXPECT_FALSE(hosts.allows(host, kLocal)) << host;
  }
}

TEST(AllowedHosts, AllowsPagesOfItsOwnAddresses) {
  const AllowedHosts hosts({"fly.example.org"});
  const auto allows = [&](const char* origin, const char* host) {
    return hosts.allows_origin(origin, host, kLocal);
  };
  EXPECT_TRUE(allows("", "127.0.0.1:8480"));
  EXPECT_TRUE(allows("http://127.0.0.1:8480", "127.0.0.1:8480"));
  EXPECT_TRUE(allows("http://localhost:8480", "127.0.0.1:8480"));
  EXPECT_TRUE(allows("http://[::1]:8480", "localhost:8480"));
  EXPECT_TRUE(allows("http://192.168.7.5:8480", "localhost:8480"));
  // Behind a proxy: the port is the scheme's.
  EXPECT_TRUE(allows("https://FLY.example.org", "fly.example.org"));
  EXPECT_TRUE(allows("http://fly.example.org", "fly.example.org:80"));
}

TEST(AllowedHosts, RefusesPagesOfOthers) {
  const AllowedHosts hosts({"fly.example.org"});
  for (const char* origin : {"null",
                             "http://evil.example",
                             "http://evil.example:8480",
                             "http://127.0.0.1.evil.example:8480",
                             "http://localhost.evil.example:8480",
                             "http://localhost:5173",
                             "http://127.0.0.1",
                             "https://127.0.0.1",
                             "http://127.0.0.1:8480/path",
                             "http://evil.example#localhost:8480",
                             "http://evil@127.0.0.1:8480",
                             "file://",
                             "127.0.0.1:8480"}) {
    EXPECT_FALSE(hosts.allows_origin(origin, "127.0.0.1:8480", kLocal)) << origin;
  }
}

TEST(AllowedHosts, TakesHostNamesAndAddressesOnly) {
  for (const char* name : {"fly.example.org", "10.0.0.9", "fd00::9", "lab_3"}) {
    EXPECT_TRUE(AllowedHosts::check_name(name)) << name;
  }
  for (const char* name : {"", "http://fly.example.org", "fly:8480", "fly/", "[::1]", "*", "a b"}) {
    EXPECT_FALSE(AllowedHosts::check_name(name)) << name;
  }
}

/// A server on every address, as in a container.
TEST(AllowedHosts, AreAskedForWhateverTheServerListensOn) {
  for (const char* address : {"127.0.0.1", "0.0.0.0"}) {
    net::ServerOptions options;
    options.address = address;
    options.allowed_hosts = {"fly.example.org"};
    TestServer server(options);
    const auto status = [&](const std::string& host, const std::string& origin = "") {
      overfly::testing::Headers headers = {{"Host", host}};
      if (!origin.empty()) headers["Origin"] = origin;
      return ask(server.port(), "GET", "/api/v1/health", "", server.with_token(headers)).status;
    };
    const std::string port = ":" + std::to_string(server.port());
    EXPECT_EQ(status("127.0.0.1" + port), 200);
    EXPECT_EQ(status("localhost"), 200);
    EXPECT_EQ(status("fly.example.org" + port), 200);
    for (const char* host : {"rebound.example", "192.168.7.5", "127.0.0.1.evil.example"}) {
      EXPECT_EQ(status(host + port), 403) << address << " " << host;
    }
    EXPECT_EQ(status("user@localhost"), 400);
    EXPECT_EQ(status("localhost", "null"), 403);
    EXPECT_EQ(status("localhost" + port, "http://evil.example" + port), 403);
    EXPECT_EQ(status("localhost" + port, "http://localhost" + port), 200);
  }
}

TEST(AllowedHosts, MustBeAskedForByExactlyOneName) {
  TestServer server;
  for (const char* hosts : {"", "Host:\r\n", "Host: localhost\r\nHost: localhost\r\n"}) {
    EXPECT_THAT(exchange_raw(server.port(),
                             std::string("GET /api/v1/health HTTP/1.1\r\n") + hosts + "\r\n"),
                StartsWith("HTTP/1.1 400"))
        << hosts;
  }
  EXPECT_THAT(exchange_raw(server.port(), "GET /api/v1/health HTTP/1.0\r\n\r\n"),
              StartsWith("HTTP/1.0 400"));
}

TEST(AllowedHosts, AreCheckedAtTheStart) {
  TestServer server;
  net::ServerOptions options;
  options.port = 0;
  options.allowed_hosts = {"http://fly.example.org"};
  const auto second = net::Server::start(options, server.runs(), server.views());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(second.error().message, HasSubstr("http://fly.example.org"));
}

}  // namespace
}  // namespace overfly::net
