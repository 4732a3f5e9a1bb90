// Exports of flights whose estimators are given calibrated intrinsics.
#include <gtest/gtest.h>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/run.hpp"
#include "tests/server/export/export_fixture.hpp"

namespace overfly::server::testing {
namespace {

using nlohmann::json;

TEST(CalibratedExport, HasWhatTheEstimatorsWereGiven) {
  const std::vector<std::string> overrides = {
      R"(camera={"width_px":640,"height_px":480,"rate_hz":2,"calibrated":{"views":8}})",
      "duration_s=0.6",
      "estimators=[]"};
  const overfly::testing::TemporaryFolder folder;
  RunOptions options = options_for(folder.path() / "run");
  options.renderer_factory = raycast_factory();
  const auto run = run_scenario(small_scenario(overrides), options);
  ASSERT_TRUE(run) << run.error().message;
  const json camera = read_json(manifest_file(folder.path() / "run")).value().at("cameras").at(0);
  const json& given = camera.at("calibrated");
  ASSERT_NE(given.at("fx_px"), camera.at("fx_px"));

  const auto exported_fx = [&](const ExportSource& source, const std::string& name) {
    exported(source, export_options(folder.path() / name, DatasetFormat::kPng));
    return read_json(folder.path() / name / "cameras.json").value().at(0).at("fx_px");
  };
  const auto source = open_export_source(folder.path() / "run");
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ(exported_fx(*source, "of_run"), given.at("fx_px"));
  // A scenario that was never flown is calibrated by the export, with the same result.
  EXPECT_EQ(exported_fx(small_source(overrides), "of_scenario"), given.at("fx_px"));
}

}  // namespace
}  // namespace overfly::server::testing
