#include "vo_bridges/lcm/lcm_findings.hpp"

#include <gmock/gmock.h>

#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"

namespace overfly {
namespace {

using ::testing::HasSubstr;

TEST(LcmFindings, AreFineWithMulticastAndALargeBuffer) {
  const LcmFindings found = lcm_findings_from("", 2 << 20);
  EXPECT_TRUE(found.usable);
  EXPECT_THAT(found.finding, HasSubstr("net.core.rmem_max = 2097152"));
  EXPECT_EQ(found.remedy, "");
}

TEST(LcmFindings, NameTheRouteThatMulticastLacks) {
  const LcmFindings found =
      lcm_findings_from("multicast to 239.255.76.67: no such device", 1 << 23);
  EXPECT_FALSE(found.usable);
  EXPECT_THAT(found.finding, HasSubstr("no such device"));
  EXPECT_THAT(found.remedy, HasSubstr("ip route add 224.0.0.0/4"));
}

TEST(LcmFindings, NameTheBufferThatIsTooSmallForImages) {
  const LcmFindings found = lcm_findings_from("", 212992);
  EXPECT_FALSE(found.usable);
  EXPECT_THAT(found.finding, HasSubstr("net.core.rmem_max = 212992"));
  EXPECT_THAT(found.remedy, HasSubstr("sysctl -w net.core.rmem_max="));
}

TEST(LcmFindings, SayWhatThisMachineOffers) {
  const LcmFindings found = lcm_findings();
  EXPECT_EQ(found.usable,
            testing::multicast_missing().empty() &&
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
}  // namespace overfly
