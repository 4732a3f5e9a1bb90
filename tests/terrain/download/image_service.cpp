#include "tests/terrain/download/image_service.hpp"

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

namespace overfly::testing {
namespace {

std::string memory_name(const char* ending) {
  static std::atomic<int> count{0};
  return "/vsimem/service_" + std::to_string(++count) + ending;
}

std::string take_bytes(const std::string& name) {
  vsi_l_offset size = 0;
  GByte* bytes = VSIGetMemFileBuffer(name.c_str(), &size, TRUE);
  std::string text(reinterpret_cast<char*>(bytes), static_cast<std::size_t>(size));
  VSIFree(bytes);
  return text;
}

void write(GDALDataset& dataset, const std::vector<float>& values, int band) {
  const int width = dataset.GetRasterXSize();
  const int height = dataset.GetRasterYSize();
  auto* data = const_cast<float*>(values.data());
  if (dataset.GetRasterBand(band)->RasterIO(
          GF_Write, 0, 0, width, height, data, width, height, GDT_Float32, 0, 0, nullptr) !=
      CE_None) {
    throw std::runtime_error("test service cannot write");
  }
}

std::vector<float> band_values(const double bbox[4], int width, int height, int band) {
  std::vector<float> values;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double x = bbox[0] + (bbox[2] - bbox[0]) * (column + 0.5) / width;
      const double y = bbox[3] - (bbox[3] - bbox[1]) * (row + 0.5) / height;
      double value = 77.0;
      if (band == 0) value = service_height_m(x, y);
      if (band == 1) value = static_cast<int>(std::floor(x / 5.0)) & 255;
      if (band == 2) value = static_cast<int>(std::floor(y / 5.0)) & 255;
      values.push_back(static_cast<float>(value));
    }
  }
  return values;
}

}  // namespace

HttpAnswer image_service_description(int most_px) {
  HttpAnswer answer;
  answer.content_type = "application/json;charset=UTF-8";
  answer.body = R"({"currentVersion":10.91,"name":"Test","bandCount":4,"pixelType":"U8",)"
                R"("copyrightText":"Test Survey","maxImageHeight":)" +
                std::to_string(most_px) + R"(,"maxImageWidth":)" + std::to_string(most_px) + "}";
  return answer;
}

double service_height_m(double x, double y) {
  return 200.0 + 20.0 * std::sin(x / 300.0) + 10.0 * std::cos(y / 200.0);
}

HttpAnswer export_image(const HttpRequest& request) {
  double bbox[4] = {};
  int width = 0;
  int height = 0;
  const bool read = std::sscanf(request.query.at("bbox").c_str(),
                                "%lf,%lf,%lf,%lf",
                                bbox,
                                bbox + 1,
                                bbox + 2,
                                bbox + 3) == 4 &&
                    std::sscanf(request.query.at("size").c_str(), "%d,%d", &width, &height) == 2;
  if (!read) throw std::runtime_error("exportImage: bbox or size is missing");
  const bool heights = request.query.at("pixelType") == "F32";
  GDALAllRegister();
  const std::string name = memory_name(".tif");
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  {
    const std::unique_ptr<GDALDataset> dataset(driver->Create(
        name.c_str(), width, height, heights ? 1 : 3, heights ? GDT_Float32 : GDT_Byte, nullptr));
    double g[6] = {
        bbox[0], (bbox[2] - bbox[0]) / width, 0.0, bbox[3], 0.0, (bbox[1] - bbox[3]) / height};
    OGRSpatialReference crs;
    crs.importFromEPSG(std::stoi(request.query.at("imageSR")));
    dataset->SetGeoTransform(g);
    dataset->SetSpatialRef(&crs);
    for (int band = heights ? 0 : 1; band <= (heights ? 0 : 3); ++band) {
      write(*dataset, band_values(bbox, width, height, band), std::max(band, 1));
    }
  }
  HttpAnswer answer;
  answer.content_type = "image/tiff";
  answer.body = take_bytes(name);
  return answer;
}

HttpAnswer picture_tile(int zoom, int x, int y, int side_px) {
  GDALAllRegister();
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const std::unique_ptr<GDALDataset> image(
      memory->Create("", side_px, side_px, 3, GDT_Byte, nullptr));
  const int values[3] = {zoom, x & 255, y & 255};
  for (int band = 1; band <= 3; ++band) image->GetRasterBand(band)->Fill(values[band - 1]);
  const std::string name = memory_name(".png");
  GDALDriver* png = GetGDALDriverManager()->GetDriverByName("PNG");
  const std::unique_ptr<GDALDataset> written(
      png->CreateCopy(name.c_str(), image.get(), FALSE, nullptr, nullptr, nullptr));
  HttpAnswer answer;
  answer.content_type = "image/png";
  answer.body = take_bytes(name);
  return answer;
}

}  // namespace overfly::testing
