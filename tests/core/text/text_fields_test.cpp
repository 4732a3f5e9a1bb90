#include "core/text/text_fields.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "tests/support/support.hpp"

namespace overfly {
namespace {

/// The time that a file's first field states in seconds, or the error.
std::string time_said(const std::string& seconds) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder.path() / "t.txt", seconds + "\n");
  const FieldFile file = FieldFile::read(folder.path() / "t.txt").value();
  const Result<std::int64_t> t_ns = file.time_s(file.lines().at(0), 1);
  return t_ns ? std::to_string(*t_ns) : t_ns.error().message;
}

TEST(TextFields, TimesEndAtTheLargestThatNanosecondsCanCount) {
  EXPECT_EQ(time_said("9223372036.854775807"), std::to_string(INT64_MAX));
  EXPECT_EQ(time_said("9223372036.8547758074"), std::to_string(INT64_MAX)) << "rounded down";
  EXPECT_EQ(time_said("-9223372036.854775807"), std::to_string(-INT64_MAX));
  for (const char* beyond : {"9223372036.8547758075",
                             "9223372036.854775808",
                             "18446744073.7095516155",  // 2^64 ns, if it is rounded up
                             "18446744073.7095516165",
                             "1e300"}) {
    EXPECT_NE(time_said(beyond).find("magnitude must be below 9.2e9 s"), std::string::npos)
        << time_said(beyond);
  }
}

}  // namespace
}  // namespace overfly
