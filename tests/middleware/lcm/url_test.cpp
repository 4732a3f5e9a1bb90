#include "middleware/lcm/url.hpp"

#include <gmock/gmock.h>

#include "middleware/lcm/network.hpp"

namespace overfly::lcm {
namespace {

using ::testing::HasSubstr;

TEST(LcmUrl, ReadsProviderNetworkAndOptions) {
  const auto url = parse_url("udpm://239.1.2.3:7000?ttl=1&recv_buf_size=5000");
  ASSERT_TRUE(url.ok());
  EXPECT_EQ(url->provider, "udpm");
  EXPECT_EQ(url->address(), "239.1.2.3");
  EXPECT_EQ(url->port(), 7000);
  EXPECT_EQ(url->options.at("ttl"), "1");
  EXPECT_EQ(url->options.at("recv_buf_size"), "5000");
}

TEST(LcmUrl, HasTheNetworkOfLcmWhereNoneIsNamed) {
  for (const char* text : {"udpm://", "udpm://:", "udpm://?ttl=0", "udpm://:7667"}) {
    const auto url = parse_url(text);
    ASSERT_TRUE(url.ok()) << text;
    EXPECT_EQ(url->address(), "239.255.76.67") << text;
    EXPECT_EQ(url->port(), 7667) << text;
  }
}

TEST(LcmUrl, LeadsToOneNetworkWhateverItsOptions) {
  const std::string own = "udpm://239.255.76.67:7667";
  for (const char* url :
       {"udpm://", "udpm://?ttl=1", "udpm://239.255.76.67?ttl=0", "udpm://:7667"}) {
    EXPECT_EQ(network_of(url), own) << url;
  }
  EXPECT_EQ(network_of("udpm://239.255.76.68:1?ttl=0"), "udpm://239.255.76.68:1");
  EXPECT_EQ(network_of("file:///a/b.lcm?mode=w"), "file:///a/b.lcm");
  EXPECT_EQ(network_of("memq://"), "memq://");
}

TEST(LcmUrl, IsWrittenAsItWasRead) {
  for (const char* text : {"udpm://239.255.76.67:7667?ttl=0",
                           "memq://",
                           "file:///logs/a b.lcm?mode=w",
                           "udpm://239.0.0.1?recv_buf_size=1&ttl=2"}) {
    EXPECT_EQ(parse_url(text)->text(), text);
  }
}

TEST(LcmUrl, GetsAReceiveBufferForImagesWhereItNamesNone) {
  const Url url = with_receive_buffer(parse_url("udpm://239.255.76.67:7667?ttl=0").value());
  EXPECT_GE(std::stoll(url.options.at("recv_buf_size")), 2 << 20);
  EXPECT_TRUE(parse_url(url.text()).ok());
}

TEST(LcmUrl, KeepsTheReceiveBufferThatItNames) {
  const auto own = parse_url("udpm://?recv_buf_size=5000").value();
  EXPECT_EQ(with_receive_buffer(own).options.at("recv_buf_size"), "5000");
  EXPECT_EQ(with_receive_buffer(parse_url("memq://").value()).text(), "memq://");
}

struct BadUrl {
  const char* text;
  const char* complaint;
};

TEST(LcmUrl, NamesWhatIsWrong) {
  const BadUrl cases[] = {
      {"", "PROVIDER://NETWORK"},
      {"239.255.76.67:7667", "PROVIDER://NETWORK"},
      {"tcpq://localhost", "provider tcpq: must be udpm, memq or file"},
      {"udpm://127.0.0.1:7667", "address 127.0.0.1: must be in 224.0.0.0"},
      {"udpm://240.0.0.1:7667", "address 240.0.0.1"},
      {"udpm://example.org:7667", "address example.org"},
      {"udpm://239.0.0.1:0", "port 0: must be in [1, 65535]"},
      {"udpm://239.0.0.1:65536", "port 65536"},
      {"udpm://239.0.0.1:7667x", "port 7667x"},
      {"udpm://?ttl=256", "ttl = 256: must be in [0, 255]"},
      {"udpm://?ttl=-1", "ttl = -1"},
      {"udpm://?recv_buf_size=0", "recv_buf_size = 0"},
      {"udpm://?recv_buf_size=2M", "recv_buf_size = 2M"},
      {"udpm://?size=2", "option size: udpm does not support it"},
      {"udpm://?ttl", "option \"ttl\": must be NAME=VALUE"},
      {"udpm://?ttl=0&ttl=1", "option ttl: given twice"},
      {"memq://name", "network name: must be empty for memq"},
      {"memq://?ttl=0", "option ttl"},
      {"file://", "path of the log"},
  };
  for (const BadUrl& bad : cases) {
    const auto url = parse_url(bad.text);
    ASSERT_FALSE(url.ok()) << bad.text;
    EXPECT_EQ(url.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(url.error().message, HasSubstr(bad.complaint));
    EXPECT_THAT(url.error().message, HasSubstr(bad.text));
  }
}

}  // namespace
}  // namespace overfly::lcm
