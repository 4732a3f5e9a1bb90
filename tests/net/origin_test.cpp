#include "server/net/origin.hpp"

#include <gtest/gtest.h>

namespace overfly::net {
namespace {

TEST(Origin, AllowsTheSameHostLoopbackAndPrograms) {
  EXPECT_TRUE(origin_allowed("", "127.0.0.1:8480"));
  EXPECT_TRUE(origin_allowed("http://fly.example.org", "fly.example.org:8480"));
  EXPECT_TRUE(origin_allowed("http://localhost:5173", "127.0.0.1:8480"));
  EXPECT_TRUE(origin_allowed("http://[::1]:5173", "localhost:8480"));
  EXPECT_TRUE(origin_allowed("https://FLY.example.org", "fly.example.org"));
}

TEST(Origin, RefusesOtherSites) {
  for (const char* origin : {"http://evil.example",
                             "null",
                             "http://127.0.0.1.evil.example",
                             "http://localhost.evil.example",
                             "http://127.evil",
                             "http://evil.example#localhost"}) {
    EXPECT_FALSE(origin_allowed(origin, "127.0.0.1:8480")) << origin;
  }
}

TEST(Origin, AsksLoopbackServersByLoopbackNamesOnly) {
  EXPECT_TRUE(host_allowed("localhost:8480", "127.0.0.1"));
  EXPECT_TRUE(host_allowed("[::1]:8480", "::1"));
  EXPECT_FALSE(host_allowed("rebound.example:8480", "127.0.0.1"));
  EXPECT_TRUE(host_allowed("fly.example.org", "0.0.0.0"));
}

}  // namespace
}  // namespace overfly::net
