#include "middleware/lcm/findings.hpp"

#include <gmock/gmock.h>

#include "middleware/lcm/node.hpp"
#include "middleware/lcm/url.hpp"

namespace overfly::lcm {
namespace {

using ::testing::HasSubstr;

TEST(LcmFindings, AreFineWithMulticastAndALargeBuffer) {
  const Findings found = findings_from("", 2 << 20);
  EXPECT_TRUE(found.usable);
  EXPECT_THAT(found.finding, HasSubstr("net.core.rmem_max = 2097152"));
  EXPECT_EQ(found.remedy, "");
}

TEST(LcmFindings, NameTheRouteThatMulticastLacks) {
  const Findings found = findings_from("multicast to 239.255.76.67: no such device", 1 << 23);
  EXPECT_FALSE(found.usable);
  EXPECT_THAT(found.finding, HasSubstr("no such device"));
  EXPECT_THAT(found.remedy, HasSubstr("ip route add 224.0.0.0/4"));
}

TEST(LcmFindings, NameTheBufferThatIsTooSmallForImages) {
  const Findings found = findings_from("", 212992);
  EXPECT_FALSE(found.usable);
  EXPECT_THAT(found.finding, HasSubstr("net.core.rmem_max = 212992"));
  EXPECT_THAT(found.remedy, HasSubstr("sysctl -w net.core.rmem_max="));
}

TEST(LcmFindings, SayWhatThisMachineOffers) {
  const Findings found = findings();
  EXPECT_EQ(found.usable,
            probe_multicast("239.255.76.67").ok() &&
                largest_receive_buffer_bytes() >= kSmallestReceiveBufferBytes);
  EXPECT_THAT(found.finding, HasSubstr("LCM 1."));
}

TEST(MulticastProbe, NamesTheAddressThatIsNone) {
  const Status status = probe_multicast("127.0.0.1");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_THAT(status.error().message, HasSubstr("127.0.0.1"));
}

}  // namespace
}  // namespace overfly::lcm
