// Text from outside in a document: nothing of it is markup, and nothing hides.
#include "server/report/plot/markup.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

namespace overfly::server::plot {
namespace {

constexpr const char* kReplaced = "\xEF\xBF\xBD";

TEST(Markup, ReplacesTheCharactersOfMarkup) {
  EXPECT_EQ(escaped("<script>alert('a & \"b\"')</script>"),
            "&lt;script&gt;alert(&#39;a &amp; &quot;b&quot;&#39;)&lt;/script&gt;");
  EXPECT_EQ(escaped("]]>"), "]]&gt;");
  EXPECT_EQ(escaped("&lt;"), "&amp;lt;");
  EXPECT_EQ(escaped("-->"), "--&gt;");
}

TEST(Markup, KeepsValidText) {
  const std::string text = "Z\xC3\xBCrich \xE2\x82\xAC \xF0\x9F\x9B\xA9 a\tb\nc";
  EXPECT_EQ(clean_text(text), text);
  EXPECT_EQ(escaped(""), "");
}

TEST(Markup, ShowsControlCharactersAndThoseThatTurnTheText) {
  EXPECT_EQ(clean_text(std::string("a\0b", 3)), std::string("a") + kReplaced + "b");
  EXPECT_EQ(clean_text("\x1B[31m\x7F\r"), std::string(kReplaced) + "[31m" + kReplaced + kReplaced);
  EXPECT_EQ(clean_text("\xC2\x85"), kReplaced);  // C1: next line
  EXPECT_EQ(clean_text("\xE2\x80\xAE"
                       "dlob"),
            std::string(kReplaced) + "dlob");            // override
  EXPECT_EQ(clean_text("\xE2\x81\xA6"), kReplaced);      // isolate
  EXPECT_EQ(clean_text("\xE2\x80\xA8"), kReplaced);      // line separator
  EXPECT_EQ(clean_text("\xEF\xBF\xBE"), kReplaced);      // U+FFFE
  EXPECT_EQ(clean_text("\xF0\x9F\xBF\xBF"), kReplaced);  // U+1FFFF
}

/// The invalid sequences of RFC 3629, section 3 and 10.
TEST(Markup, ReplacesEachByteThatIsNoUtf8) {
  const auto replaced = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += kReplaced;
    return text;
  };
  EXPECT_EQ(clean_text("\xFF\xFE"), replaced(2));
  EXPECT_EQ(clean_text("\xC0\xBC"), replaced(2));          // "<" in two bytes
  EXPECT_EQ(clean_text("\xE0\x80\xBC"), replaced(3));      // "<" in three
  EXPECT_EQ(clean_text("\xED\xA0\x80"), replaced(3));      // a surrogate
  EXPECT_EQ(clean_text("\xF4\x90\x80\x80"), replaced(4));  // above U+10FFFF
  EXPECT_EQ(clean_text("a\xE2\x82"), "a" + replaced(2));   // cut off
  EXPECT_EQ(escaped("\xE2<b>"), replaced(1) + "&lt;b&gt;");
}

TEST(Markup, CutsLongTextsBetweenCharacters) {
  EXPECT_EQ(clean_text("abcdef", 3), "abc\xE2\x80\xA6");
  EXPECT_EQ(clean_text("ab\xE2\x82\xAC", 4), "ab\xE2\x80\xA6");
  EXPECT_EQ(clean_text("ab\xE2\x82\xAC", 5), "ab\xE2\x82\xAC");
  EXPECT_LT(escaped(std::string(1'000'000, '<')).size(), 5 * kMaxTextBytes);
}

/// The test vectors of RFC 4648, section 10.
TEST(Markup, Base64OfTheTestVectors) {
  const auto of = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foob"), "Zm9vYg==");
  EXPECT_EQ(of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(of("\xFF\xEF\xBE"), "/+++");
}

TEST(Markup, NumbersAreShortAndNeverWords) {
  EXPECT_EQ(attribute_number(12.0), "12");
  EXPECT_EQ(attribute_number(12.34), "12.3");
  EXPECT_EQ(attribute_number(-0.01), "0");
  EXPECT_EQ(attribute_number(-1.25, 2), "-1.25");
  EXPECT_EQ(attribute_number(100.0, 0), "100");
  EXPECT_EQ(attribute_number(std::numeric_limits<double>::quiet_NaN()), "0");
  EXPECT_EQ(attribute_number(std::numeric_limits<double>::infinity()), "0");
  EXPECT_GT(attribute_number(1e300).size(), 300U);
}

}  // namespace
}  // namespace overfly::server::plot
