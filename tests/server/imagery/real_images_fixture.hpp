// A flight with real images on its first camera and virtual ones on its second, for tests.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "server/export/dataset_export.hpp"
#include "server/record/rows/agreement_rows.hpp"
#include "server/record/run_records.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scoring/agreement_report.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {

inline constexpr double kFovDeg = 40.0;
inline constexpr int kFrames = 21;
/// Of the camera: 80 px / tan(fov / 2).
inline const double kFocalPx = 80.0 / std::tan(0.5 * kFovDeg * EIGEN_PI / 180.0);

inline RendererFactory one_thread_raycaster() {
  return [](std::shared_ptr<const terrain::TileSource> tiles) {
    renderer::RendererOptions options;
    options.threads = 1;
    return Result<std::unique_ptr<renderer::Renderer>>(
        renderer::create_raycast_renderer(std::move(tiles), options));
  };
}

inline nlohmann::json flight_document() {
  nlohmann::json document = testing::small_document();
  document["camera"]["fov_deg"] = kFovDeg;
  document["epoch_utc_s"] = 1'700'000'000;
  return document;
}

inline Scenario scenario_of(nlohmann::json document) {
  auto scenario = resolve_scenario(std::move(document), {}, "/");
  if (!scenario) throw std::runtime_error(scenario.error().message);
  return std::move(*scenario);
}

/// The same flight with real images on the first camera and virtual ones on the second.
inline nlohmann::json twin_document(const nlohmann::json& images,
                                    const nlohmann::json& mount = nlohmann::json::object()) {
  nlohmann::json document = flight_document();
  nlohmann::json real = document["camera"];
  real["mount"] = mount;
  nlohmann::json rendered = real;
  real["name"] = "real";
  real["images"] = images;
  real["images"]["compare_with"] = "virtual";
  rendered["name"] = "virtual";
  document.erase("camera");
  document["cameras"] = {real, rendered};
  document["estimators"] = {{{"name", "on_real"}, {"type", "feature"}, {"camera", "real"}},
                            {{"name", "on_virtual"}, {"type", "feature"}, {"camera", "virtual"}}};
  return document;
}

class RealImages : public ::testing::Test {
 protected:
  std::filesystem::path exported(DatasetFormat format) {
    ExportSource source{scenario_of(flight_document()), std::nullopt, 1'700'000'000 * kNsPerS};
    ExportOptions options;
    options.folder = folder_.path() / "export";
    options.format = format;
    options.renderer_factory = one_thread_raycaster();
    const auto summary = export_dataset(source, options);
    if (!summary) throw std::runtime_error(summary.error().message);
    EXPECT_EQ(summary->images, kFrames);
    return options.folder;
  }

  /// Flies, and reads the report of the run's folder.
  AgreementReport flown(const nlohmann::json& document) {
    const Scenario scenario = scenario_of(document);
    RunOptions options;
    options.folder = run();
    options.renderer_factory = one_thread_raycaster();
    const auto result = run_scenario(scenario, options);
    if (!result) throw std::runtime_error(result.error().message);
    metrics_ = result->metrics;
    const auto rows = read_agreement(run());
    if (!rows) throw std::runtime_error(rows.error().message);
    const auto report = report_agreement(scenario, *rows);
    if (!report) throw std::runtime_error(report.error().message);
    return *report;
  }

  /// Lossless images: the offset is nothing, and the estimator's answers are the same to the byte.
  void expect_identical(const AgreementReport& report) {
    EXPECT_EQ(report.frames, kFrames);
    EXPECT_EQ(report.lost, 0);
    EXPECT_EQ(report.missing, 0);
    EXPECT_LT(report.offset_px->p95, 1e-3);
    EXPECT_GT(report.correlation->p5, 0.999999);
    EXPECT_EQ(report.corners_real->median, report.corners_virtual->median);
    EXPECT_GT(report.corners_real->median, 10);
    ASSERT_EQ(report.estimators.size(), 1U);
    EXPECT_EQ(report.estimators[0].real, "on_real");
    EXPECT_EQ(report.estimators[0].rendered, "on_virtual");
    const std::string real = overfly::testing::read_text(run() / "estimates" / "on_real.jsonl");
    EXPECT_FALSE(real.empty());
    EXPECT_EQ(real, overfly::testing::read_text(run() / "estimates" / "on_virtual.jsonl"));
  }

  [[nodiscard]] std::filesystem::path run() const { return folder_.path() / "run"; }

  overfly::testing::TemporaryFolder folder_;
  RunMetrics metrics_;
};

}  // namespace overfly::server
