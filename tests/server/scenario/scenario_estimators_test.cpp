// Estimators of a scenario: what each door takes, and what it refuses.
#include "server/run/run_options.hpp"
#include "server/scenario/document/estimators/estimator_entry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/estimators/estimator_factory.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "tests/support/support.hpp"
#include "vo_bridges/lcm/lcm_options.hpp"

namespace overfly::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

Result<EstimatorSpec> read(const std::string& entry) {
  return estimator_from_json(Json::parse(entry), "/scenarios/of/mine");
}

EstimatorSpec spec_of(const std::string& entry) {
  Result<EstimatorSpec> spec = read(entry);
  if (!spec) throw std::runtime_error(spec.error().message);
  return *spec;
}

TEST(ScenarioEstimators, ProcessKeepsEveryField) {
  const EstimatorSpec spec = spec_of(R"({
    "name": "x", "type": "process", "command": ["bin/vo", "./a.yaml", "b", "../c"],
    "cpus": [1, 3], "memory_limit_mb": 500, "start_timeout_s": 60, "answer_timeout_s": 2.5,
    "parameters": {"n": 3, "flag": true, "file": "orb.txt"}})");
  EXPECT_THAT(
      spec.command,
      ElementsAre(
          "/scenarios/of/mine/bin/vo", "/scenarios/of/mine/a.yaml", "b", "/scenarios/of/c"));
  EXPECT_THAT(spec.cpus, ElementsAre(1, 3));
  EXPECT_EQ(spec.memory_limit_mb, 500.0);
  EXPECT_EQ(spec.start_timeout_s, 60.0);
  EXPECT_EQ(spec.answer_timeout_s, 2.5);
  EXPECT_EQ(text_of(spec.parameters.at("n")), "3");
  EXPECT_EQ(text_of(spec.parameters.at("flag")), "true");
  EXPECT_EQ(text_of(spec.parameters.at("file")), "orb.txt");
  EXPECT_THAT(
      spec_of(R"({"name": "x", "type": "process", "command": ["python3", "./vo.py"]})").command,
      ElementsAre("python3", "/scenarios/of/mine/vo.py"));
  EXPECT_EQ(spec_of(R"({"name": "x", "type": "process", "listen": "unix:vo.sock"})").listen,
            "unix:/scenarios/of/mine/vo.sock");
  EXPECT_EQ(spec_of(R"({"name": "x", "type": "process", "listen": "unix:/run/vo"})").listen,
            "unix:/run/vo");
}

/// A run folder's copy of a scenario is flown again from there.
TEST(ScenarioEstimators, ResolvedDocumentMeansTheSameProgramElsewhere) {
  const Json document = Json::parse(R"({
    "format_version": 1, "world": {"builtin": {}}, "flight": {"course": {}},
    "estimators": [{"name": "x", "type": "process", "command": ["./vo"], "listen": "unix:s"}]})");
  const auto first = resolve_scenario(document, {}, "/one");
  ASSERT_TRUE(first.ok()) << first.error().message;
  const auto again = resolve_scenario(first->resolved, {}, "/two");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_THAT(again->estimators[0].command, ElementsAre("/one/vo"));
  EXPECT_EQ(again->estimators[0].listen, "unix:/one/s");
}

/// The schema's defaults are those of the doors' own options.
TEST(ScenarioEstimators, DefaultsAreThoseOfTheDoors) {
  const Ros1EstimatorOptions ros1 = spec_of(R"({"name": "x", "type": "ros1", "ros1": {}})").ros1;
  const Ros1EstimatorOptions plain;
  EXPECT_EQ(ros1.master_uri, plain.master_uri);
  EXPECT_EQ(ros1.node_name, plain.node_name);
  EXPECT_EQ(ros1.image_topic, plain.image_topic);
  EXPECT_EQ(ros1.camera_info_topic, plain.camera_info_topic);
  EXPECT_EQ(ros1.pose_topic, plain.pose_topic);
  EXPECT_EQ(ros1.pose_type, plain.pose_type);
  EXPECT_EQ(ros1.debug_image_topic, plain.debug_image_topic);
  EXPECT_EQ(ros1.camera_frame, plain.camera_frame);
  EXPECT_EQ(ros1.vo_frame, plain.vo_frame);
  EXPECT_EQ(ros1.pose_is_camera_from_world, plain.pose_is_camera_from_world);
  EXPECT_EQ(ros1.pose_in_body_axes, plain.pose_in_body_axes);
  EXPECT_EQ(ros1.publish_clock, plain.publish_clock);
  EXPECT_EQ(ros1.publish_tf, plain.publish_tf);
  EXPECT_EQ(ros1.parameter_namespace, plain.parameter_namespace);
  EXPECT_EQ(ros1.queue_size, plain.queue_size);
  const EstimatorSpec lcm = spec_of(R"({"name": "x", "type": "lcm", "lcm": {}})");
  EXPECT_EQ(lcm.lcm_url, LcmEstimatorOptions().url);
  EXPECT_EQ(lcm.lcm_channel_prefix, LcmEstimatorOptions().channel_prefix);
}

struct Refused {
  const char* entry;
  const char* why;
};

TEST(ScenarioEstimators, FieldsOfOtherDoorsAreRefusedByName) {
  const Refused cases[] = {
      {R"({"name": "x", "type": "feature", "command": ["vo"]})",
       R"(estimators.0.command = ["vo"]: must be left out if type is feature)"},
      {R"({"name": "x", "type": "lcm", "command": ["vo"]})", "if type is lcm"},
      {R"({"name": "x", "type": "lcm", "cpus": [0]})", "estimators.0.cpus = [0]: must be left out"},
      {R"({"name": "x", "type": "perfect", "memory_limit_mb": 10})", "memory_limit_mb = 10"},
      {R"({"name": "x", "type": "process", "command": ["vo"], "ros1": {}})", "estimators.0.ros1"},
      {R"({"name": "x", "type": "feature", "answer_timeout_s": 1})", "answer_timeout_s = 1"},
      {R"({"name": "x", "type": "process"})", "estimators.0.command: must be given"},
      {R"({"name": "x", "type": "process", "listen": "tcp:a:1", "memory_limit_mb": 10})",
       "left out without a command"},
      {R"({"name": "x", "type": "process", "command": [""]})",
       R"(estimators.0.command.0 = "": must name a program)"},
      {R"({"name": "x", "type": "process", "command": ["a\u0000b"]})", "must hold no NUL"},
      {R"({"name": "x", "type": "process", "command": []})", "estimators.0.command"},
      {R"({"name": "x", "type": "process", "listen": "udp:a:1"})", "estimators.0.listen"},
      {R"({"name": "x", "type": "process", "command": ["vo"], "start_timeout_s": 3601})",
       "estimators.0.start_timeout_s = 3601: must be in (0, 3600]"},
      {R"({"name": "x", "type": "feature", "parameters": {"a": [1]}})",
       "estimators.0.parameters.a = [1]: must be exactly one of a number, true or false, text"},
      {R"({"name": "x", "type": "feature", "throttle_hz": 20})", "pacing is lockstep"},
      {R"({"name": "x", "type": "ros1", "ros1": {"pose_type": "pose"}})", "ros1.pose_type"},
      {R"({"name": "x", "type": "ros1", "ros1": {"image_topic": "a b"}})", "ros1.image_topic"}};
  for (const Refused& refused : cases) {
    const Result<EstimatorSpec> spec = read(refused.entry);
    ASSERT_FALSE(spec.ok()) << refused.entry;
    EXPECT_EQ(spec.error().code, ErrorCode::kInvalidArgument) << refused.entry;
    EXPECT_THAT(spec.error().message, HasSubstr(refused.why)) << refused.entry;
  }
}

std::string verdict_on(const std::string& one, const std::string& other) {
  const Json document = {{"format_version", 1},
                         {"world", {{"builtin", Json::object()}}},
                         {"flight", {{"course", Json::object()}}},
                         {"estimators",
                          {Json::parse(R"({"name": "a",)" + one + "}"),
                           Json::parse(R"({"name": "b",)" + other + "}")}}};
  const auto scenario = resolve_scenario(document, {}, "/one");
  return scenario ? "fine" : scenario.error().message;
}

TEST(ScenarioEstimators, ThatWouldAnswerForEachOtherOnLcmAreRefused) {
  const std::string plain = R"("type": "lcm")";
  EXPECT_EQ(verdict_on(plain, R"("type": "lcm", "lcm": {"channel_prefix": "B_"})"), "fine");
  EXPECT_EQ(verdict_on(plain, R"("type": "lcm", "lcm": {"url": "udpm://239.255.76.68:7667"})"),
            "fine");
  for (const char* other :
       {R"("type": "lcm")", R"("type": "lcm", "lcm": {"url": "udpm://?ttl=1"})"}) {
    EXPECT_THAT(
        verdict_on(plain, other),
        HasSubstr(R"(estimators.1.lcm.channel_prefix = "OVERFLY_": must differ between )"
                  R"(estimators "a" and "b", which are both on udpm://239.255.76.67:7667)"));
  }
}

TEST(ScenarioEstimators, ThatWouldAnswerForEachOtherOnRosAreRefused) {
  const auto ros1 = [](const std::string& fields) {
    return R"("type": "ros1", "ros1": {)" + fields + "}";
  };
  const std::string one = ros1("");
  const std::string apart = R"("image_topic": "/b/image", "camera_info_topic": "/b/info")";
  EXPECT_EQ(verdict_on(one, ros1(apart + R"(, "pose_topic": "/b/pose")")), "fine");
  EXPECT_THAT(verdict_on(one, ros1(apart)),
              HasSubstr(R"(estimators.1.ros1.pose_topic = "/vo/pose": must not be the pose_topic )"
                        R"(of another: estimators "a" and "b" each need one of their own)"));
  EXPECT_THAT(verdict_on(one, ros1(R"("image_topic": "/b", "pose_topic": "/c")")),
              HasSubstr("estimators.1.ros1.camera_info_topic"));
  EXPECT_THAT(verdict_on(one, ros1(apart + R"(, "pose_topic": "vo/pose")")),
              HasSubstr("estimators.1.ros1.pose_topic = \"vo/pose\""));
  EXPECT_THAT(verdict_on(one, ros1(apart + R"(, "pose_topic": "/c",
                                           "debug_image_topic": "/camera/image_raw")")),
              HasSubstr("estimators.1.ros1.debug_image_topic"));
  const std::string tf = R"("pose_type": "tf")";
  EXPECT_THAT(verdict_on(ros1(tf), ros1(tf + "," + apart)),
              HasSubstr("estimators.1.ros1.camera_frame = \"camera in world on /tf\""));
  EXPECT_EQ(verdict_on(ros1(tf), ros1(tf + R"(, "vo_frame": "map",)" + apart)), "fine");
}

TEST(EstimatorFactory, MakesEstimatorsWithoutAScenario) {
  EstimatorSpec spec;
  spec.name = "mine";
  spec.type = "feature";
  spec.parameters["features"] = 500.0;
  const auto port = create_estimator(spec, {7, true, {}});
  ASSERT_TRUE(port.ok()) << port.error().message;
  EXPECT_EQ((*port)->effective_parameters().at("features"), "500");
  EXPECT_EQ((*port)->effective_parameters().at("seed"), "7");
}

TEST(EstimatorFactory, NamesEstimatorParameterAndLimit) {
  EstimatorSpec spec;
  spec.name = "mine";
  spec.type = "feature";
  spec.parameters["features"] = std::string("many");
  const auto text = create_estimator(spec, {});
  ASSERT_FALSE(text.ok());
  EXPECT_THAT(text.error().message, HasSubstr("\"mine\""));
  EXPECT_THAT(text.error().message, HasSubstr("parameters.features = \"many\""));
  spec.type = "orbslam";
  spec.parameters.clear();
  EXPECT_THAT(create_estimator(spec, {}).error().message, HasSubstr("type = \"orbslam\""));
  spec.type = "perfect";
  EXPECT_THAT(create_estimator(spec, {}).error().message, HasSubstr("needs the truth"));
}

}  // namespace
}  // namespace overfly::server
