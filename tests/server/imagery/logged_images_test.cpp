// Real images by the clock of a log, and the fields of a scenario with real images.
#include <algorithm>
#include <functional>

#include "core/text/number_text.hpp"
#include "tests/server/imagery/real_images_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;

/// A level flight to the north at 20 m/s over the middle of the world. The clock of its log stands
/// at kLogStartS when it begins.
class RealImagesOfALog : public RealImages {
 protected:
  static constexpr int kLogStartS = 1000;

  RealImagesOfALog() {
    std::string gps = "t,lat,lon,alt,roll,pitch,yaw\n";
    for (int i = 0; i <= 100; ++i) {
      gps += number_text(kLogStartS + 0.1 * i) + ',' + number_text(1.0 + 1.8087e-5 * i) +
             ",2,100,0,0,0\n";
    }
    overfly::testing::write_text(folder_.path() / "gps.csv", gps);
    overfly::testing::write_text(folder_.path() / "log.json",
                                 R"({"csv_mapping_version": 1, "pieces": [
      {"name": "GPS", "file": "gps.csv", "origin": "gps", "time": {"column": "t", "unit": "s"},
       "columns": {"lat": {"column": "lat", "unit": "deg"}, "lon": {"column": "lon", "unit": "deg"},
                   "alt_msl": {"column": "alt", "unit": "m"},
                   "roll": {"column": "roll", "unit": "deg"},
                   "pitch": {"column": "pitch", "unit": "deg"},
                   "yaw": {"column": "yaw", "unit": "deg"}}}]})");
  }
  [[nodiscard]] Json of_log(Json document) const {
    Json log = {{"file", (folder_.path() / "log.json").string()},
                {"smooth", Json::object()},
                {"rebase", {{"lowest_agl_m", 150}}}};
    document["flight"] = {{"log", std::move(log)}};
    return document;
  }
  /// Exports to PNG. @return the first images folder's files in order
  std::vector<std::string> export_of(const ExportSource& source, const std::string& name) {
    ExportOptions options;
    options.folder = folder_.path() / name;
    options.renderer_factory = one_thread_raycaster();
    options.cameras = {source.scenario.cameras[0].name};
    const auto summary = export_dataset(source, options);
    if (!summary) throw std::runtime_error(summary.error().message);
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(options.folder / "images")) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<std::string> images;
    for (const fs::path& file : files) images.push_back(overfly::testing::read_text(file));
    return images;
  }
};

TEST_F(RealImagesOfALog, CountByTheClockOfTheLogInARunAndInItsExport) {
  const ExportSource source{
      scenario_of(of_log(flight_document())), std::nullopt, 1'700'000'000 * kNsPerS};
  const std::vector<std::string> rendered = export_of(source, "export");
  ASSERT_EQ(rendered.size(), static_cast<std::size_t>(kFrames));
  // The export's stamps count from the start of the flight.
  const Json images = {{"source", (folder_.path() / "export").string()},
                       {"clock", "log"},
                       {"time_offset_s", kLogStartS}};
  expect_identical(flown(of_log(twin_document(images))));
  const auto manifest = read_run_manifest(run());
  ASSERT_TRUE(manifest.ok());
  EXPECT_EQ(manifest->values.flight->log_start_ns, kLogStartS * kNsPerS);
  const auto again = open_export_source(run());
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(export_of(*again, "again"), rendered);
}

TEST(RealImagesOfAScenario, AreCheckedWithTheirFields) {
  const auto message_of = [](const std::function<void(Json&)>& change) {
    Json document = twin_document({{"source", "flight.bag"}});
    change(document);
    const auto scenario = resolve_scenario(document, {}, "/");
    return scenario ? std::string("accepted") : scenario.error().message;
  };
  EXPECT_EQ(message_of([](Json&) {}), "accepted");
  EXPECT_THAT(
      message_of([](Json& d) { d["cameras"][0]["images"]["clock"] = "log"; }),
      HasSubstr("cameras.0.images.clock = \"log\": must be given together with flight.log"));
  EXPECT_THAT(message_of([](Json& d) {
                d["cameras"][0]["images"]["clock"] = "utc";
                d.erase("epoch_utc_s");
              }),
              HasSubstr("must be given together with epoch_utc_s"));
  EXPECT_THAT(message_of([](Json& d) { d["cameras"][1]["width_px"] = 170; }),
              HasSubstr("must name a camera of the same model and mount"));
  EXPECT_THAT(message_of([](Json& d) { d["cameras"][0]["images"]["compare_with"] = "none"; }),
              HasSubstr("must name another camera of the scenario"));
  EXPECT_THAT(message_of([](Json& d) { d["cameras"][0]["color"] = "rgb"; }),
              HasSubstr("must be grey"));
  EXPECT_THAT(message_of([](Json& d) {
                d["cameras"][1]["images"] = {{"source", "b.bag"}};
              }),
              HasSubstr("only one camera can have recorded images"));
  EXPECT_THAT(message_of([](Json& d) {
                d["cameras"][0]["vibration"] = {{"engine_rpm", 5000}};
              }),
              HasSubstr("cameras.0.vibration"));
}

}  // namespace
}  // namespace overfly::server
