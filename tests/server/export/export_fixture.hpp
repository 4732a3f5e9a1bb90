// What the tests of the exports share: sources over the small world, and files read back.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/export/dataset_export.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::testing {

/// The ray-caster with one thread: real images without EGL.
[[nodiscard]] RendererFactory raycast_factory();

/// A scenario of small_scenario() as what is exported.
[[nodiscard]] ExportSource small_source(const std::vector<std::string>& overrides = {});
[[nodiscard]] ExportOptions export_options(const std::filesystem::path& folder,
                                           DatasetFormat format);
/// Exports; throws where that fails.
ExportSummary exported(const ExportSource& source, const ExportOptions& options);

/// Every frame of a scenario, made apart from the export.
[[nodiscard]] std::vector<MadeFrame> frames_of(const Scenario& scenario);

/// Fields of the lines that do not begin with '#'.
[[nodiscard]] std::vector<std::vector<std::string>> rows_of(const std::filesystem::path& file,
                                                            char separator);
/// Numbers behind `key` in a line of a text ("intrinsics: [1, 2]" gives 1 and 2).
[[nodiscard]] std::vector<double> numbers_behind(const std::string& text, const std::string& key);

/// A picture as OpenCV reads it, unchanged but for the order of colours (red, green, blue).
[[nodiscard]] cv::Mat read_picture(const std::filesystem::path& file);
/// A TIFF of three 64-bit channels as GDAL reads it: OpenCV cannot.
[[nodiscard]] cv::Mat read_points(const std::filesystem::path& file);
/// How many samples differ; fails the test where size or kind do.
[[nodiscard]] int different_samples(const cv::Mat& read, const Image& image);
[[nodiscard]] int different_samples(const cv::Mat& read, const Image16& image);

}  // namespace overfly::server::testing
