#include "tests/server/export/export_fixture.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>

namespace overfly::server::testing {
namespace {

template <typename T>
int count_different(const cv::Mat& read, const ImageBuffer<T>& image) {
  if (read.cols != image.width_px || read.rows != image.height_px ||
      read.channels() != image.channels || read.depth() != cv::DataType<T>::depth) {
    ADD_FAILURE() << "read " << read.cols << " x " << read.rows << " px, " << read.channels()
                  << " channels of depth " << read.depth() << ", made " << image.width_px << " x "
                  << image.height_px << " px, " << image.channels << " channels";
    return -1;
  }
  const std::size_t row = static_cast<std::size_t>(image.width_px) * image.channels;
  int different = 0;
  for (int y = 0; y < read.rows; ++y) {
    for (std::size_t i = 0; i < row; ++i) {
      different += read.ptr<T>(y)[i] != image.data[static_cast<std::size_t>(y) * row + i];
    }
  }
  return different;
}

}  // namespace

RendererFactory raycast_factory() {
  return [](std::shared_ptr<const terrain::TileSource> tiles) {
    renderer::RendererOptions options;
    options.threads = 1;
    return Result<std::unique_ptr<renderer::Renderer>>(
        renderer::create_raycast_renderer(std::move(tiles), options));
  };
}

ExportSource small_source(const std::vector<std::string>& overrides) {
  ExportSource source;
  source.scenario = small_scenario(overrides);
  source.epoch_utc_ns = 1'700'000'000 * kNsPerS;
  return source;
}

ExportOptions export_options(const std::filesystem::path& folder, DatasetFormat format) {
  ExportOptions options;
  options.folder = folder;
  options.format = format;
  options.renderer_factory = raycast_factory();
  return options;
}

ExportSummary exported(const ExportSource& source, const ExportOptions& options) {
  Result<ExportSummary> summary = export_dataset(source, options);
  if (!summary) throw std::runtime_error(summary.error().message);
  return std::move(*summary);
}

std::vector<MadeFrame> frames_of(const Scenario& scenario) {
  FrameMakerOptions options;
  options.renderer_factory = raycast_factory();
  const auto maker = FrameMaker::open(scenario, options);
  if (!maker) throw std::runtime_error(maker.error().message);
  std::vector<MadeFrame> frames;
  for (std::int64_t k = 0; k < (*maker)->frames_total(); ++k) {
    auto frame = (*maker)->make(k);
    if (!frame) throw std::runtime_error(frame.error().message);
    frames.push_back(std::move(frame->value()));
  }
  return frames;
}

std::vector<std::vector<std::string>> rows_of(const std::filesystem::path& file, char separator) {
  std::ifstream stream(file);
  EXPECT_TRUE(stream.good()) << file;
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, separator);) rows.back().push_back(field);
    if (line.back() == separator) rows.back().emplace_back();
  }
  return rows;
}

std::vector<double> numbers_behind(const std::string& text, const std::string& key) {
  const std::size_t begin = text.find(key);
  if (begin == std::string::npos) {
    ADD_FAILURE() << "no " << key << " in " << text;
    return {};
  }
  const std::size_t end = text.find('\n', begin);
  std::string line = text.substr(begin + key.size(), end - begin - key.size());
  for (char& c : line) {
    if (c == ',' || c == '[' || c == ']' || c == ':') c = ' ';
  }
  std::istringstream stream(line);
  std::vector<double> numbers;
  for (double number = 0.0; stream >> number;) numbers.push_back(number);
  return numbers;
}

cv::Mat read_picture(const std::filesystem::path& file) {
  cv::Mat read = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  EXPECT_FALSE(read.empty()) << file;
  if (read.channels() == 3) {
    cv::Mat swapped(read.size(), read.type());
    cv::mixChannels(read, swapped, {0, 2, 1, 1, 2, 0});
    return swapped;
  }
  return read;
}

cv::Mat read_points(const std::filesystem::path& file) {
  GDALAllRegister();
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
  if (!dataset || dataset->GetRasterCount() != 3) {
    ADD_FAILURE() << file << " is no raster of three channels";
    return {};
  }
  cv::Mat points(dataset->GetRasterYSize(), dataset->GetRasterXSize(), CV_64FC3);
  int channels[] = {1, 2, 3};
  const CPLErr read = dataset->RasterIO(GF_Read,
                                        0,
                                        0,
                                        points.cols,
                                        points.rows,
                                        points.data,
                                        points.cols,
                                        points.rows,
                                        GDT_Float64,
                                        3,
                                        channels,
                                        24,
                                        24 * points.cols,
                                        8,
                                        nullptr);
  EXPECT_EQ(read, CE_None) << file;
  EXPECT_EQ(dataset->GetRasterBand(1)->GetRasterDataType(), GDT_Float64);
  return points;
}

int different_samples(const cv::Mat& read, const Image& image) {
  return count_different(read, image);
}
int different_samples(const cv::Mat& read, const Image16& image) {
  return count_different(read, image);
}

}  // namespace overfly::server::testing
