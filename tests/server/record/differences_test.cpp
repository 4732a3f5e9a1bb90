#include "server/record/comparison/differences.hpp"

#include <gtest/gtest.h>

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using Values = std::vector<std::optional<std::string>>;

TEST(Differences, AreTheFieldsThatAreNotTheSame) {
  const Json a = {{"seed", 1}, {"title", "x"}, {"camera", {{"rate_hz", 31}, {"width_px", 640}}}};
  Json b = a;
  b["camera"]["rate_hz"] = 15.5;
  b["title"] = "y \"z\"";
  const Differences found = differences_between({a, b, a});
  ASSERT_EQ(found.fields.size(), 2U);
  EXPECT_EQ(found.fields[0].field, "camera.rate_hz");
  EXPECT_EQ(found.fields[0].values, (Values{"31", "15.5", "31"}));
  EXPECT_EQ(found.fields[1].field, "title");
  EXPECT_EQ(found.fields[1].values, (Values{"x", "y \"z\"", "x"}));
  EXPECT_EQ(found.left_out, 0U);
}

TEST(Differences, OfEqualDocumentsAndOfOneAreNone) {
  const Json a = Json::parse(R"({"a":[1,{"b":null}],"c":{}})");
  EXPECT_TRUE(differences_between({a, a}).fields.empty());
  EXPECT_TRUE(differences_between({a}).fields.empty());
  EXPECT_TRUE(differences_between({}).fields.empty());
  EXPECT_TRUE(differences_between({Json(1), Json(1.0)}).fields.empty());
}

/// Estimators are compared by name, whatever their order, and one that a run lacks is one field.
TEST(Differences, MatchElementsOfListsByTheirNames) {
  const Json a = Json::parse(R"({"e":[{"name":"p","n":1},{"name":"q","n":2}]})");
  const Json b = Json::parse(R"({"e":[{"name":"q","n":2},{"name":"p","n":3}]})");
  const Json c = Json::parse(R"({"e":[{"name":"p","n":1}]})");
  const Differences found = differences_between({a, b});
  ASSERT_EQ(found.fields.size(), 1U);
  EXPECT_EQ(found.fields[0].field, "e.p.n");
  const Differences lacking = differences_between({a, c});
  ASSERT_EQ(lacking.fields.size(), 1U);
  EXPECT_EQ(lacking.fields[0].field, "e.q");
  EXPECT_EQ(lacking.fields[0].values, (Values{R"({"n":2,"name":"q"})", std::nullopt}));
  // Without names, or with equal ones, by their places.
  const Differences placed =
      differences_between({Json::parse("[[1,2],[3]]"), Json::parse("[[1,5],[3]]")});
  ASSERT_EQ(placed.fields.size(), 1U);
  EXPECT_EQ(placed.fields[0].field, "0.1");
  const Json twice = Json::parse(R"([{"name":"p","n":1},{"name":"p","n":2}])");
  const Json changed = Json::parse(R"([{"name":"p","n":1},{"name":"p","n":4}])");
  EXPECT_EQ(differences_between({twice, changed}).fields.at(0).field, "1.n");
}

TEST(Differences, OfOtherKindsOfValues) {
  const Differences found = differences_between({Json::parse(R"({"w":{"builtin":{"seed":1}}})"),
                                                 Json::parse(R"({"w":"file.json"})"),
                                                 Json::parse("{}")});
  ASSERT_EQ(found.fields.size(), 1U);
  EXPECT_EQ(found.fields[0].values,
            (Values{R"({"builtin":{"seed":1}})", "file.json", std::nullopt}));
  // Bytes that are no UTF-8 do not throw.
  EXPECT_EQ(differences_between({Json("\xFF"), Json(1)}).fields.at(0).values.at(0), "\xFF");
  EXPECT_NO_THROW(static_cast<void>(differences_between({Json{{"a", {"\xFF"}}}, Json{{"b", 1}}})));
}

TEST(Differences, AreAtMostSoMany) {
  Json a = Json::object();
  Json b = Json::object();
  for (int i = 0; i < 500; ++i) {
    a["f" + std::to_string(1000 + i)] = i;
    b["f" + std::to_string(1000 + i)] = -1;
  }
  const Differences found = differences_between({a, b}, 20);
  EXPECT_EQ(found.fields.size(), 20U);
  EXPECT_EQ(found.left_out, 480U);
  EXPECT_EQ(found.fields[0].field, "f1000");
}

TEST(Leaves, AreAllValuesWithTheirPaths) {
  const auto leaves = leaves_of(Json::parse(
      R"({"a":{"b":[1,"x"],"empty":{},"none":[]},"c":null,"l":[{"name":"n","v":true}]})"));
  const std::vector<std::pair<std::string, std::string>> expected = {{"a.b.0", "1"},
                                                                     {"a.b.1", "x"},
                                                                     {"a.empty", "{}"},
                                                                     {"a.none", "[]"},
                                                                     {"c", "null"},
                                                                     {"l.n.name", "n"},
                                                                     {"l.n.v", "true"}};
  EXPECT_EQ(leaves, expected);
}

}  // namespace
}  // namespace overfly::server
