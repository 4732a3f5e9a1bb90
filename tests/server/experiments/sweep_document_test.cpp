// Sweep files and their cells.
#include "server/experiments/sweep_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/time.hpp"
#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::HasSubstr;

class SweepDocument : public ::testing::Test {
 protected:
  /// The course with these fields of the sweep.
  Result<Sweep> loaded(const std::string& fields) {
    const fs::path file = folder_.path() / "sweep.json";
    const std::string scenario = (fs::path(OVERFLY_SOURCE_DIR) / "scenarios/course.json").string();
    write_text(file, R"({"format_version": 1, "scenario": ")" + scenario + "\", " + fields + "}");
    return load_sweep(file);
  }
  std::string fault_of(const std::string& fields) {
    const Result<Sweep> sweep = loaded(fields);
    if (!sweep) return sweep.error().message;
    const auto cells = cells_of(*sweep);
    return cells ? "" : cells.error().message;
  }

  TemporaryFolder folder_;
};

TEST_F(SweepDocument, TheGridChangesTheLastAxisFastest) {
  const auto sweep = loaded(
      R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 25]},
                  {"path": "flight.course.height_agl_m", "from": 50, "to": 150, "step": 50}])");
  ASSERT_TRUE(sweep.ok()) << sweep.error().message;
  const auto cells = cells_of(*sweep);
  ASSERT_TRUE(cells.ok());
  ASSERT_EQ(cells->size(), 6U);
  const Json second = {{"flight.course.airspeed_m_s", 10}, {"flight.course.height_agl_m", 100.0}};
  EXPECT_EQ((*cells)[1].values, second);
  const auto scenario = scenario_of(*sweep, (*cells)[5], 2);
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  const auto& course = std::get<flight::CourseParameters>(scenario->flight);
  EXPECT_EQ(course.airspeed_m_s, 25.0);
  EXPECT_EQ(course.height_agl_m, 150.0);
  EXPECT_EQ(scenario->seed, 3U);  // the file's 1 and two repeats
}

TEST_F(SweepDocument, FlightsHaveFewDebugImagesUnlessTheSweepAsksForMore) {
  const auto debug_hz = [&](const std::string& changes) {
    const auto sweep =
        loaded(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10]}], "set": {)" +
               changes + "}");
    EXPECT_TRUE(sweep) << (sweep ? "" : sweep.error().message);
    const auto scenario = scenario_of(*sweep, cells_of(*sweep)->front(), 1);
    EXPECT_TRUE(scenario) << (scenario ? "" : scenario.error().message);
    EXPECT_EQ(scenario->resolved.at("recording").at("debug_hz"), scenario->record_debug_hz);
    return scenario->record_debug_hz;
  };
  EXPECT_EQ(debug_hz(""), kSweepDebugHz);
  EXPECT_EQ(debug_hz(R"("recording.frames": true)"), kSweepDebugHz);
  EXPECT_EQ(debug_hz(R"("recording": {"frames": true})"), kSweepDebugHz);
  EXPECT_EQ(debug_hz(R"("recording.debug_hz": 5)"), 5.0);
  EXPECT_EQ(debug_hz(R"("recording": {"debug_hz": 0})"), 0.0);
}

TEST_F(SweepDocument, VariantsChangeSeveralFields) {
  const auto sweep = loaded(
      R"("axes": [{"name": "light", "variants": [
           {"value": "slow", "set": {"flight.course.airspeed_m_s": 10, "duration_s": 5}},
           {"value": "fast", "set": {"flight.course.airspeed_m_s": 25, "duration_s": 3}}]}],
         "repeats": {"most": 2, "vary_world": true})");
  ASSERT_TRUE(sweep.ok()) << sweep.error().message;
  const auto cells = cells_of(*sweep);
  ASSERT_EQ(cells->size(), 2U);
  EXPECT_EQ(cells->back().values, Json({{"light", "fast"}}));
  const auto scenario = scenario_of(*sweep, cells->back(), 1);
  EXPECT_EQ(scenario->duration_s, 3.0);
  EXPECT_EQ(std::get<BuiltinWorld>(scenario->world).seed, 2U);
}

TEST_F(SweepDocument, RepeatsStartAtInstantsSpreadOverTheFirstSeconds) {
  const auto sweep = loaded(R"("axes": [], "set": {"start_s": 1},
                               "repeats": {"most": 20, "vary_start_s": 5})");
  ASSERT_TRUE(sweep.ok()) << sweep.error().message;
  const auto cells = cells_of(*sweep);
  std::vector<double> starts_s;
  for (int repeat = 0; repeat < 20; ++repeat) {
    const auto scenario = scenario_of(*sweep, cells->front(), repeat);
    ASSERT_TRUE(scenario.ok()) << scenario.error().message;
    starts_s.push_back(s_from_ns(scenario->start_ns));
  }
  EXPECT_EQ(starts_s.front(), 1.0);
  std::sort(starts_s.begin(), starts_s.end());
  EXPECT_LT(starts_s.back(), 6.0);
  for (std::size_t i = 1; i < starts_s.size(); ++i) {
    EXPECT_GT(starts_s[i] - starts_s[i - 1], 0.05);
    EXPECT_LT(starts_s[i] - starts_s[i - 1], 0.65);
  }
}

TEST_F(SweepDocument, SkipsCellsThatMatchEveryField) {
  const auto sweep = loaded(
      R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 25]},
                  {"path": "flight.course.height_agl_m", "values": [50, 100, 200]}],
         "skip": [{"flight.course.airspeed_m_s": 25, "flight.course.height_agl_m": {"max": 100}}])");
  ASSERT_TRUE(sweep.ok()) << sweep.error().message;
  const auto cells = cells_of(*sweep);
  ASSERT_EQ(cells->size(), 4U);
  EXPECT_EQ(cells->back().values.at("flight.course.height_agl_m"), 200);
}

/// Each axis is cut into as many parts as there are cells, and each part has one value.
TEST_F(SweepDocument, ALatinHypercubeUsesEachPartOnce) {
  const auto sweep = loaded(
      R"("axes": [{"path": "flight.course.airspeed_m_s", "from": 10, "to": 30},
                  {"path": "flight.course.height_agl_m", "values": [50, 100]}],
         "latin_hypercube": {"cells": 20, "seed": 7})");
  ASSERT_TRUE(sweep.ok()) << sweep.error().message;
  const auto cells = cells_of(*sweep);
  ASSERT_EQ(cells->size(), 20U);
  std::set<int> parts;
  int low = 0;
  for (const SweepCell& cell : *cells) {
    parts.insert(static_cast<int>(cell.values.at("flight.course.airspeed_m_s").get<double>() - 10));
    low += cell.values.at("flight.course.height_agl_m") == 50 ? 1 : 0;
  }
  EXPECT_EQ(parts.size(), 20U);
  EXPECT_EQ(low, 10);
  EXPECT_EQ(cells_of(*sweep)->at(3).values, cells->at(3).values) << "the same each time";
}

TEST_F(SweepDocument, ValuesOfARangeAreTheDecimalsThatItMeans) {
  const auto values_of = [&](const std::string& range) {
    std::string text;
    const auto sweep = loaded(R"("axes": [{"path": "duration_s", )" + range + "}]");
    EXPECT_TRUE(sweep.ok()) << sweep.error().message;
    for (const AxisValue& value : sweep->axes[0].values) text += value.value.dump() + " ";
    return text;
  };
  EXPECT_EQ(values_of(R"("from": 0, "to": 1, "step": 0.1)"),
            "0.0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1.0 ");
  EXPECT_EQ(values_of(R"("from": -0.3, "to": 0.1, "step": 0.1)"), "-0.3 -0.2 -0.1 0.0 0.1 ");
  EXPECT_EQ(values_of(R"("from": 1.1, "to": 4.4, "step": 1.1)"), "1.1 2.2 3.3 4.4 ");
  EXPECT_EQ(values_of(R"("from": 0.001, "to": 0.0035, "step": 0.0005)"),
            "0.001 0.0015 0.002 0.0025 0.003 0.0035 ");
  // Those that are exact, or no short decimals, are as computed.
  EXPECT_EQ(values_of(R"("from": 1234567890123, "to": 1234567890125, "step": 1)"),
            "1234567890123.0 1234567890124.0 1234567890125.0 ");
  EXPECT_EQ(values_of(R"("from": 0, "to": 2e-6, "step": 9.5367431640625e-07)"),
            "0.0 9.5367431640625e-07 1.9073486328125e-06 ");
  const std::string skipping =
      R"("axes": [{"path": "duration_s", "from": 0.1, "to": 0.4, "step": 0.1}],
         "skip": [{"duration_s": 0.3}])";
  EXPECT_EQ(cells_of(*loaded(skipping))->size(), 3U);
}

TEST_F(SweepDocument, ValuesOfAnAxisMustDiffer) {
  EXPECT_THAT(fault_of(R"("axes": [{"name": "air", "variants": [
                  {"value": "calm", "set": {"seed": 1}}, {"value": "gusts", "set": {"seed": 2}},
                  {"value": "calm", "set": {"seed": 3}}]}])"),
              HasSubstr("axes.0.variants.2.value = calm: must differ from those before it"));
  EXPECT_THAT(fault_of(R"("axes": [{"path": "seed", "values": [1, 2, 1.0]}])"),
              HasSubstr("axes.0.values.2 = 1.0: must differ from those before it"));
}

TEST_F(SweepDocument, NamesWhatIsInvalid) {
  EXPECT_THAT(fault_of(R"("axes": [], "repeats": {"most": 0})"), HasSubstr("repeats.most = 0"));
  EXPECT_THAT(fault_of(R"("axes": [], "wrong": 1)"), HasSubstr("wrong"));
  EXPECT_THAT(fault_of(R"("axes": [{"path": "seed", "from": 5, "to": 1, "step": 1}])"),
              HasSubstr("axes.0.to = 1: must be at least axes.0.from = 5"));
  EXPECT_THAT(fault_of(R"("axes": [{"path": "seed", "from": 1, "to": 5}])"),
              HasSubstr("axes.0.step: must be given"));
  EXPECT_THAT(fault_of(R"("axes": [{"path": "seed", "from": 0, "to": 1e300, "step": 1}])"),
              HasSubstr("more than 10000"));
  const std::string misspelt = fault_of(R"("axes": [{"path": "seed", "vals": [1]}])");
  EXPECT_THAT(misspelt,
              HasSubstr("must be exactly one of {path, values}, {path, from, to, step}, "
                        "{name, variants} (unknown: vals)"));
  EXPECT_EQ(misspelt.find('?'), std::string::npos);
  EXPECT_THAT(
      fault_of(R"("axes": [{"path": "seed", "values": [1]}, {"path": "seed", "values": [2]}])"),
      HasSubstr("axes.1 = seed"));
  EXPECT_THAT(fault_of(R"("axes": [{"path": "seed", "values": [1]}], "skip": [{"sead": 1}])"),
              HasSubstr("skip.0.sead"));
  EXPECT_THAT(
      fault_of(R"("axes": [{"path": "seed", "values": [1]}], "skip": [{"seed": {"least": 1}}])"),
      HasSubstr("skip.0.seed.least"));
  EXPECT_THAT(fault_of(R"("axes": [{"path": "seed", "values": [1]}], "skip": [{"seed": 1}])"),
              HasSubstr("at least one cell"));
}

/// Each cell has a copy of its values: a small file must not fill the memory.
TEST_F(SweepDocument, TheValuesOfAllCellsAreLimited) {
  const std::string text =
      R"({"path": "description", "values": [")" + std::string(1'000'000, 'x') + R"("]})";
  const std::string steps = R"("from": 1, "to": 100, "step": 1})";
  const std::string grid = R"("axes": [)" + text + R"(, {"path": "seed", )" + steps +
                           R"(, {"path": "duration_s", )" + steps + "]";
  EXPECT_THAT(fault_of(grid), HasSubstr("axes: the values of 10000 cells have 19"));
  EXPECT_THAT(fault_of(grid), HasSubstr(" MiB: must be at most 64 MiB"));
  const std::string drawn = R"("axes": [)" + text + R"(], "latin_hypercube": {"cells": )";
  EXPECT_THAT(fault_of(drawn + "100}"), HasSubstr("must be at most 64 MiB"));
  EXPECT_EQ(fault_of(drawn + "10}"), "");
}

TEST_F(SweepDocument, AnInvalidCellIsNamed) {
  const auto sweep =
      loaded(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [25, -4]}])");
  ASSERT_TRUE(sweep.ok());
  const auto cells = cells_of(*sweep);
  const auto scenario = scenario_of(*sweep, cells->at(1), 0);
  ASSERT_FALSE(scenario.ok());
  EXPECT_THAT(scenario.error().message, HasSubstr("flight.course.airspeed_m_s = -4"));
}

/// The files that Overfly comes with.
TEST(SweepFiles, AreValid) {
  std::size_t files = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(OVERFLY_SOURCE_DIR) / "scenarios/sweeps")) {
    if (!entry.is_regular_file()) continue;
    const auto sweep = load_sweep(entry.path());
    ASSERT_TRUE(sweep.ok()) << sweep.error().message;
    const auto cells = cells_of(*sweep);
    ASSERT_TRUE(cells.ok()) << cells.error().message;
    for (const SweepCell& cell : *cells) {
      const auto scenario = scenario_of(*sweep, cell, 0);
      EXPECT_TRUE(scenario.ok()) << scenario.error().message;
    }
    ++files;
  }
  EXPECT_EQ(files, 6U);
}

}  // namespace
}  // namespace overfly::server::experiments
