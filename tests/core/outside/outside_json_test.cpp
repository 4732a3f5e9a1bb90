#include "core/outside/outside_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace overfly {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string nested(std::size_t depth, const std::string& open, const std::string& close) {
  std::string text;
  for (std::size_t i = 0; i < depth; ++i) text += open;
  text += "1";
  for (std::size_t i = 0; i < depth; ++i) text += close;
  return text;
}

TEST(OutsideJson, ReadsDocumentsUpToTheDepthLimit) {
  EXPECT_TRUE(json_from_outside<json>(nested(kMaxJsonDepth, "[", "]"), "x").ok());
  EXPECT_TRUE(json_from_outside<json>(nested(kMaxJsonDepth, R"({"a":)", "}"), "x").ok());
  EXPECT_EQ(json_from_outside<nlohmann::ordered_json>(R"({"b": [1, {"c": null}], "a": 2})", "x")
                .value()
                .dump(),
            R"({"b":[1,{"c":null}],"a":2})");
}

TEST(OutsideJson, RefusesWhatIsNestedDeeper) {
  for (const auto& text : {nested(kMaxJsonDepth + 1, "[", "]"),
                           nested(kMaxJsonDepth + 1, R"({"a":)", "}"),
                           nested(500'000, R"([{"a":)", "}]"),
                           std::string(2'000'000, '[')}) {
    const Result<json> read = json_from_outside<json>(text, "the body");
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, ErrorCode::kUnreadable);
    EXPECT_EQ(read.error().message, "the body: is nested more than 64 deep");
  }
}

TEST(OutsideJson, CountsNoBracketInsideAText) {
  const std::string brackets(1000, '[');
  const std::string text = R"(["\")" + brackets + R"(\\", ")" + brackets + R"("])";
  const Result<json> read = json_from_outside<json>(text, "x");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->at(0), "\"" + brackets + "\\");
  EXPECT_EQ(read->at(1), brackets);
}

TEST(OutsideJson, CountsSiblingsOnce) {
  std::string text = "[0";
  for (int i = 0; i < 1000; ++i) text += ",[[{}]]";
  EXPECT_TRUE(json_from_outside<json>(text + "]", "x").ok());
}

TEST(OutsideJson, RefusesAKeyThatIsGivenTwice) {
  const auto fault = [](const std::string& text) {
    const Result<json> read = json_from_outside<json>(text, "a.json");
    const auto ordered = json_from_outside<nlohmann::ordered_json>(text, "a.json");
    EXPECT_EQ(read.ok(), ordered.ok());
    if (!read && !ordered) EXPECT_EQ(read.error().message, ordered.error().message);
    return read ? "" : read.error().message;
  };
  const std::string twice = ": must be given at most once";
  EXPECT_EQ(fault(R"({"a": 1, "a": 1})"), "a.json: a" + twice);
  EXPECT_EQ(fault(R"({"x": {"b": 1}, "e": [7, [{}], {"n": {"k:": 1, "b": [2], "k:": 3}}]})"),
            "a.json: e.2.n.k:" + twice);
  EXPECT_EQ(fault(R"([{"a": {}, "a": {"a": 1}}, {"b": 1, "b": 2}])"), "a.json: 0.a" + twice);
  EXPECT_EQ(fault(R"({"\u0061": 1, "a": 2})"), "a.json: a" + twice) << "the same key";
  EXPECT_EQ(fault(R"([{"a": ":", ":": "\":"}, {"a": {"a": null}}, [], {}, 3, "{\"a\":1}"])"), "");
}

TEST(OutsideJson, SaysWhereTheSyntaxIsWrongAndQuotesLittle) {
  const Result<json> read = json_from_outside<json>("{\n  \"a\": x}", "a.json");
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.error().message, HasSubstr("a.json, line 2, column 8: syntax error"));
  const std::string open_text = "[\"" + std::string(1'000'000, 'x');
  EXPECT_LT(json_from_outside<json>(open_text, "x").error().message.size(), 300U);
  EXPECT_EQ(json_from_outside<json>("1e999", "x").error().code, ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace overfly
