// Mutated scenarios and the program's verdicts on them; scenario/ajv asks another validator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/files/json_schema.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_schema.hpp"
#include "server/scenario/scenario.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Mutant {
  std::string name;
  Json document;
};

/// Several cameras, light, detail and faults.
Json cameras_seed() {
  return Json::parse(R"({
    "format_version": 1, "world": {"builtin": {}}, "flight": {"course": {}},
    "cameras": [
      {"name": "a", "mount": {"facing": "forward", "roll_deg": 1, "pitch_deg": 2, "yaw_deg": 3,
                              "p_body_m": [1, 2, 3]}},
      {"name": "b", "mount": {"q_xyzw": [0, 0, 0, 1]}, "color": "rgb", "quality": "reference"}],
    "renderer": {"camera": "raycast", "device": "0", "threads": 2},
    "light": {"time_utc": "2026-06-21T17:30Z", "ambient": 0.3, "hill_shading": 0.5,
              "cast_shadows": 0.5,
              "clouds": {"cover": 0.2, "size_m": 300, "strength": 0.5, "seed": 2}},
    "detail": {"octaves": 2, "strength": 0.5, "seed": 3},
    "faults": [
      {"kind": "dropped_frames", "at_s": 1, "duration_s": 2, "camera": "a", "every": 2},
      {"kind": "dropped_frames", "at_s": 1, "probability": 0.5},
      {"kind": "water_drop", "at_s": 1, "strength": 0.5, "radius_px": 20, "count": 2},
      {"kind": "stamp_jitter", "at_s": 1, "sigma_ms": 2},
      {"kind": "stamp_offset", "at_s": 1, "offset_ms": -20}],
    "estimators": [{"name": "e", "type": "feature", "camera": "b"}]})");
}

/// One camera with all that it can have.
Json camera_seed() {
  return Json::parse(R"({
    "format_version": 1, "world": {"builtin": {}}, "flight": {"course": {}},
    "light": {"sun_azimuth_deg": 120, "sun_elevation_deg": 40},
    "camera": {
      "bits": 12, "rate_hz": 20,
      "distortion": {"model": "fov", "coefficients": [0.5]},
      "atmosphere": {"visibility_km": 10, "airlight_rgb": [184, 204, 224]},
      "sensor": {"defocus_sigma_px": 0.5, "vignette": [-0.1, 0, 0], "exposure_ms": 2,
                 "readout_ms": 10, "motion_blur": true, "electrons_per_s": 5000000,
                 "shot_noise": true, "prnu": 0.01, "dsnu_e": 1, "full_well_e": 10000,
                 "read_noise_e": 5, "gain_dn_per_e": 0.1, "black_level_dn": 4, "adc_bits": 12,
                 "response": {"shape": "table", "table": [0, 0.6, 1]},
                 "auto_exposure": {"target_mean": 0.4, "min_exposure_ms": 0.1,
                                   "max_exposure_ms": 10, "max_gain": 4, "settle_frames": 6}},
      "vibration": {"engine_rpm": 5000, "engine_rotation_rms_mrad": [1],
                    "engine_translation_rms_mm": [1], "noise_rotation_rms_mrad": [1, 1, 1],
                    "noise_translation_rms_mm": [1, 1, 1], "noise_low_hz": 5,
                    "noise_high_hz": 100, "mount_natural_hz": 30, "mount_damping": 0.2}}})");
}

/// Estimators behind every door.
Json doors_seed() {
  return Json::parse(R"({
    "format_version": 1, "world": {"builtin": {}}, "flight": {"course": {}},
    "pacing": "real_time",
    "estimators": [
      {"name": "child", "type": "process", "command": ["./vo", "--fast"], "cpus": [0, 1],
       "listen": "unix:vo.sock", "memory_limit_mb": 2000, "start_timeout_s": 60,
       "answer_timeout_s": 2.5, "throttle_hz": 20,
       "parameters": {"ini": 20, "fast": true, "vocabulary": "orb.txt"}},
      {"name": "far", "type": "process", "listen": "tcp:127.0.0.1:9000"},
      {"name": "lcm", "type": "lcm",
       "lcm": {"url": "udpm://239.255.76.67:7667?ttl=0", "channel_prefix": "VO_"}},
      {"name": "ros", "type": "ros1", "ros1": {
        "master_uri": "http://127.0.0.1:11311", "node_name": "range", "image_topic": "/image",
        "camera_info_topic": "/info", "pose_topic": "/pose", "pose_type": "odometry",
        "debug_image_topic": "/debug", "camera_frame": "cam",
        "vo_frame": "map", "pose_is_camera_from_world": true, "pose_in_body_axes": true,
        "publish_clock": false, "publish_tf": true, "parameter_namespace": "/svo",
        "queue_size": 2}}]})");
}

/// Documents that between them use every field of the format.
std::vector<Mutant> seeds() {
  Json course = Json::parse(R"({
    "format_version": 1, "name": "a-1", "title": "t", "description": "d", "seed": 3,
    "epoch_utc_s": 1767225600, "data": "data",
    "world": {"imagery": [{"file": "a.tif", "crs": "EPSG:2994", "attribution": "x"}],
              "elevation": [{"file": "b.tif", "vertical_datum": "navd88", "geoid_separation_m": -22.5,
                             "unit_m": 0.3048, "crs": "EPSG:2994", "attribution": "y"}],
              "ground_height_m": 12.5,
              "origin": {"lat_deg": 44, "lon_deg": -123, "alt_ellipsoid_m": 100},
              "runway": {"lat_deg": 44, "lon_deg": -123, "heading_deg": 180}},
    "flight": {"course": {"airspeed_m_s": 25, "roll_rate_max_deg_s": 45, "height_agl_m": 300,
                          "bank_max_deg": 45, "length_m": 3300, "leg_length_m": 1100,
                          "start": {"east_m": 1, "north_m": 2}, "heading_deg": 180}},
    "duration_s": 40,
    "camera": {"width_px": 1280, "height_px": 960, "rate_hz": 31, "fx_px": 700, "fy_px": 700,
               "cx_px": 639.5, "cy_px": 479.5},
    "estimators": [{"name": "feature", "type": "feature", "parameters": {"features": 1000}}],
    "pacing": "real_time", "recording": {"frames": true, "debug_hz": 2}})");
  Json log = Json::parse(R"({
    "format_version": 1, "world": {"manifest": "world.json"},
    "flight": {"log": {"file": "flight.csv", "camera_poses": false}},
    "camera": {"fov_deg": 84.872, "fov_axis": "horizontal"},
    "estimators": [{"name": "p", "type": "perfect"}, {"name": "d", "type": "drifting"}]})");
  Json logged = Json::parse(R"({
    "format_version": 1, "world": {"manifest": "world.json"},
    "flight": {"log": {
      "file": "flight.bin", "source": "GPS", "from_s": 10, "to_s": 60.5, "time_offset_s": 0.25,
      "geoid_separation_m": -33,
      "smooth": {"jump_m": 3, "jump_deg": 5, "jerk_psd_m2_s5": 10, "angular_psd_rad2_s3": 0.1,
                 "board": {"roll_deg": 1, "pitch_deg": -2, "yaw_deg": 90}},
      "rebase": {"point": "start", "east_m": 100, "north_m": -50, "lowest_agl_m": 120,
                 "turn_deg": -45}}}})");
  Json moved = Json::parse(R"({
    "format_version": 1, "world": {"manifest": "world.json"},
    "flight": {"log": {
      "file": "flight.bin", "time_offset_s": "auto", "smooth": {},
      "rebase": {"lat_deg": 35.7, "lon_deg": -120.7, "lowest_agl_m": 120}}}})");
  Json builtin = Json::parse(R"({
    "format_version": 1, "world": {"builtin": {"seed": 7}},
    "flight": {"course": {"start": "runway"}}})");
  return {{"course", course},
          {"log", log},
          {"logged", logged},
          {"moved", moved},
          {"builtin", builtin},
          {"cameras", cameras_seed()},
          {"camera", camera_seed()},
          {"doors", doors_seed()}};
}

/// Every place in a document, as JSON pointers.
void collect_places(const Json& node,
                    const Json::json_pointer& at,
                    std::vector<Json::json_pointer>& places) {
  if (!at.empty()) places.push_back(at);
  if (node.is_object()) {
    for (const auto& [key, child] : node.items()) collect_places(child, at / key, places);
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) collect_places(node[i], at / i, places);
  }
}

/// Values of other types and at the edges, put in the place of `value`.
std::vector<Json> replacements(const Json& value) {
  std::vector<Json> others = {nullptr, "text", Json::array(), Json::object(), true};
  if (value.is_number()) {
    for (const Json& number : {Json(-1),
                               Json(0),
                               Json(1),
                               Json(2.0),
                               Json(0.5),
                               Json(1e9),
                               Json(-180.0001),
                               Json(180),
                               Json(90.0001),
                               Json(9007199254740992)}) {
      others.push_back(number);
    }
  }
  if (value.is_string()) {
    for (const char* text : {"", "runway", "a b", "feature", "\u00e9t\u00e9", "-x"}) {
      others.emplace_back(text);
    }
  }
  others.erase(std::remove(others.begin(), others.end(), value), others.end());
  return others;
}

void mutate_place(const Mutant& seed,
                  const Json::json_pointer& place,
                  std::vector<Mutant>& mutants) {
  const std::string name = seed.name + place.to_string();
  for (const Json& other : replacements(seed.document.at(place))) {
    Json document = seed.document;
    document[place] = other;
    mutants.push_back({name + " = " + other.dump(), std::move(document)});
  }
  Json without = seed.document;
  Json& parent = without[place.parent_pointer()];
  if (parent.is_object()) {
    parent.erase(place.back());
  } else {
    parent.erase(std::stoul(place.back()));
  }
  mutants.push_back({name + " removed", std::move(without)});
  if (seed.document.at(place).is_object()) {
    Json with = seed.document;
    with[place]["surplus"] = 1;
    mutants.push_back({name + " with a surplus field", std::move(with)});
  }
}

std::vector<Mutant> all_mutants() {
  std::vector<Mutant> mutants;
  for (const Mutant& seed : seeds()) {
    mutants.push_back(seed);
    std::vector<Json::json_pointer> places;
    collect_places(seed.document, Json::json_pointer(), places);
    for (const Json::json_pointer& place : places) mutate_place(seed, place, mutants);
  }
  for (const char* text : {"null", "[]", "{}", "1", "\"x\""}) {
    mutants.push_back({std::string("whole document ") + text, Json::parse(text)});
  }
  return mutants;
}

TEST(ScenarioMutations, SeedsAreValid) {
  for (const Mutant& seed : seeds())
    EXPECT_TRUE(schema_violations(seed.document).empty()) << seed.name;
}

TEST(ScenarioMutations, EachHasAVerdictAndInvalidOnesNameAField) {
  Json verdicts = Json::array();
  int invalid = 0;
  for (const Mutant& mutant : all_mutants()) {
    const auto violations = schema_violations(mutant.document);
    verdicts.push_back(
        {{"name", mutant.name}, {"document", mutant.document}, {"valid", violations.empty()}});
    if (violations.empty()) continue;
    ++invalid;
    for (const auto& [path, text] : violations) {
      EXPECT_THAT(text, HasSubstr(path));
      EXPECT_THAT(text, AnyOf(HasSubstr(": must be "), HasSubstr(": no such field")))
          << mutant.name;
    }
  }
  const int valid = static_cast<int>(verdicts.size()) - invalid;
  EXPECT_GE(verdicts.size(), 200U);
  EXPECT_GE(invalid, 150);
  EXPECT_GE(valid, 30);
  if (const char* file = std::getenv("OVERFLY_VERDICTS_FILE"); file != nullptr) {
    overfly::testing::write_text(file, verdicts.dump());
  }
}

/// One number of each field moved out of its limits: the message has file, field, value and limit.
TEST(ScenarioMutations, BadNumberNamesFileFieldValueAndLimit) {
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "bad.json";
  int tried = 0;
  for (const Mutant& seed : seeds()) {
    std::vector<Json::json_pointer> places;
    collect_places(seed.document, Json::json_pointer(), places);
    for (const Json::json_pointer& place : places) {
      const bool open_ended = place.to_string().find("/parameters/") != std::string::npos;
      if (!seed.document.at(place).is_number() || open_ended) continue;
      Json document = seed.document;
      document[place] = -1e15;
      overfly::testing::write_text(file, document.dump());
      const Result<Scenario> scenario = load_scenario(file, {});
      ASSERT_FALSE(scenario.ok()) << seed.name << place.to_string();
      std::string field = place.to_string().substr(1);
      std::replace(field.begin(), field.end(), '/', '.');
      EXPECT_THAT(
          scenario.error().message,
          AllOf(StartsWith(file.string() + ": "), HasSubstr(field + " = -1e+15: must be ")));
      ++tried;
    }
  }
  EXPECT_GE(tried, 80);
}

/// What passes the schema either resolves or is refused for a reason that is not a bug.
TEST(ScenarioMutations, ValidOnesResolveOrAreRefusedWithAReason) {
  for (const Mutant& mutant : all_mutants()) {
    const bool valid = schema_violations(mutant.document).empty();
    const Result<Scenario> scenario = resolve_scenario(mutant.document, {}, "/tmp");
    if (!valid) {
      ASSERT_FALSE(scenario.ok()) << mutant.name;
      EXPECT_EQ(scenario.error().code, ErrorCode::kInvalidArgument) << mutant.name;
    } else if (!scenario) {
      EXPECT_EQ(scenario.error().code, ErrorCode::kInvalidArgument)
          << mutant.name << ": " << scenario.error().message;
    }
  }
}

TEST(ScenarioSchema, UsesOnlyKeywordsThatTheProgramUnderstands) {
  const JsonSchema schema(Json::parse(scenario_schema_text()));
  EXPECT_THAT(schema.unknown_keywords(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace overfly::server
