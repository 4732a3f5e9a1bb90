#include "vo_bridges/estimator_text.hpp"

#include <gtest/gtest.h>

namespace overfly {
namespace {

TEST(EstimatorText, MakesAnyBytesPrintable) {
  EXPECT_EQ(printable("a\tb\x01\xFF"
                      "c\xC3\xA9"),
            "a b??c\xC3\xA9");
  EXPECT_EQ(printable("\xC0\x80\xED\xA0\x80"), "?????") << "overlong, and a surrogate";
  EXPECT_EQ(printable("ab\xC3\xA9", 3), "ab") << "no character is cut in two";
}

TEST(EstimatorText, HasNoColoursOfATerminal) {
  EXPECT_EQ(printable("\x1B[0;33m[WARN] lost\x1B[0;0m"), "[WARN] lost");
  EXPECT_EQ(printable("\x1B[0m"), "");
  EXPECT_EQ(printable("\x1B[1 qa\x1B[38;5;196"), "a?[38;5;196") << "the last one is incomplete";
  EXPECT_EQ(printable("\x1B[31mab", 2), "ab") << "they do not count";
  EXPECT_EQ(printable("\x1B]0;title"), "?]0;title");
}

TEST(EstimatorText, LimitsNamesToPrintableAsciiWithoutSpaces) {
  for (const char* name : {"n", "inliers", "tracker/levels", "~!"}) {
    EXPECT_TRUE(is_figure_name(name)) << name;
  }
  for (const char* name : {"", "two words", "line\n", "\x7F", "caf\xC3\xA9"}) {
    EXPECT_FALSE(is_figure_name(name)) << name;
  }
  EXPECT_TRUE(is_figure_name(std::string(kNameLimitBytes, 'x')));
  EXPECT_FALSE(is_figure_name(std::string(kNameLimitBytes + 1, 'x')));
}

}  // namespace
}  // namespace overfly
