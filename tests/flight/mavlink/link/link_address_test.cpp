#include "flight/mavlink/link/link_address.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace overfly::flight::mavlink {
namespace {

using ::testing::HasSubstr;

TEST(LinkAddress, ReadsAndWritesEveryKind) {
  for (const char* const text : {"udp-listen:127.0.0.1:14550",
                                 "udp-listen:0.0.0.0:0",
                                 "udp:192.168.1.7:14555",
                                 "tcp:[::1]:5760",
                                 "tcp-listen:[::]:5760",
                                 "serial:/dev/ttyUSB0:57600",
                                 "serial:/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:115200"}) {
    const Result<LinkAddress> address = parse_link_address(text, "link");
    ASSERT_TRUE(address.ok()) << address.error().message;
    EXPECT_EQ(address->text(), text);
  }
  const Result<LinkAddress> local = parse_link_address("tcp:localhost:5760", "link");
  ASSERT_TRUE(local.ok());
  EXPECT_EQ(local->host, "127.0.0.1");
  EXPECT_EQ(local->port, 5760);
}

TEST(LinkAddress, NamesFieldValueAndLimit) {
  const auto message_of = [](std::string_view text) {
    const Result<LinkAddress> address = parse_link_address(text, "flight.mavlink.link");
    EXPECT_FALSE(address.ok()) << text;
    return address.ok() ? std::string() : address.error().message;
  };
  EXPECT_EQ(message_of("udp:127.0.0.1:0"),
            "flight.mavlink.link = 'udp:127.0.0.1:0': the port must be in [1, 65535]");
  EXPECT_THAT(message_of("udp-listen:127.0.0.1:65536"), HasSubstr("in [0, 65535]"));
  EXPECT_THAT(message_of("tcp:127.0.0.1:"), HasSubstr("port must be"));
  EXPECT_THAT(message_of("tcp:127.0.0.1:+5"), HasSubstr("port must be"));
  EXPECT_THAT(message_of("tcp:example.org:5760"), HasSubstr("numeric address"));
  EXPECT_THAT(message_of("tcp:::1:5760"), HasSubstr("IPv6 in brackets"));
  EXPECT_THAT(message_of("tcp:[127.0.0.1]:5760"), HasSubstr("numeric address"));
  EXPECT_THAT(message_of("tcp::5760"), HasSubstr("numeric address"));
  EXPECT_THAT(message_of("serial:/dev/ttyS0:57601"), HasSubstr("baud rate must be one of 9600"));
  EXPECT_THAT(message_of("serial:ttyS0:57600"), HasSubstr("absolute path"));
  EXPECT_THAT(message_of(""), HasSubstr("must be udp-listen:HOST:PORT"));
  EXPECT_THAT(message_of("udp:"), HasSubstr("must be udp-listen:HOST:PORT"));
  EXPECT_THAT(message_of("http://host:80"), HasSubstr("must be udp-listen:HOST:PORT"));
  EXPECT_THAT(message_of("tcp:\x01:1"), HasSubstr("'tcp:?:1'"));
  EXPECT_THAT(message_of("tcp:" + std::string(300, '1') + ":1"), HasSubstr("256 characters"));
}

}  // namespace
}  // namespace overfly::flight::mavlink
