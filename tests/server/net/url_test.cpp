#include "server/net/http/url.hpp"

#include <gtest/gtest.h>

namespace overfly::net {
namespace {

using Segments = std::vector<std::string>;

TEST(Url, SplitsPathAndQuery) {
  const auto url = parse_target("/api/v1/runs?format=json&a=b%20c+d&flag");
  ASSERT_TRUE(url);
  EXPECT_EQ(url->segments, (Segments{"api", "v1", "runs"}));
  EXPECT_EQ(url->query.at("format"), "json");
  EXPECT_EQ(url->query.at("a"), "b c d");
  EXPECT_EQ(url->query.at("flag"), "");
}

TEST(Url, NamesAParameterThatIsGivenTwice) {
  EXPECT_EQ(parse_target("/a?x=1&y=2&%78=1")->repeated, "x");
  EXPECT_FALSE(parse_target("/a?x=1&y=1")->repeated);
}

TEST(Url, DecodesInsideSegmentsOnly) {
  EXPECT_EQ(parse_target("/a%2Fb/c")->segments, (Segments{"a/b", "c"}));
  EXPECT_EQ(parse_target("/a+b")->segments, (Segments{"a+b"}));
  EXPECT_EQ(parse_target("/")->segments, Segments{});
  EXPECT_EQ(parse_target("/a/")->segments, (Segments{"a", ""}));
}

TEST(Url, RefusesBrokenTargets) {
  for (const char* target : {"", "a", "*", "/%", "/%1", "/%zz", "/a%00b", "/?x=%0", "http://a/b"}) {
    EXPECT_FALSE(parse_target(target)) << target;
  }
}

}  // namespace
}  // namespace overfly::net
