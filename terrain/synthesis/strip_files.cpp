#include "terrain/synthesis/strip_files.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

#include "core/helper_threads.hpp"
#include "terrain/decoration/noise.hpp"
#include "terrain/raster/georeference.hpp"
#include "terrain/synthesis/geotiff_writer.hpp"
#include "terrain/synthesis/landscape/painter.hpp"

namespace overfly::terrain::synthesis {
namespace fs = std::filesystem;
namespace {

constexpr int kStripOverviews = 9;  ///< down to 2 texels for kStripStepPx
constexpr int kBlockRows = 1 << kStripOverviews;

Error strip_cancelled(const fs::path& file) {
  return {ErrorCode::kCancelled, "synthesis of " + file.string() + " was cancelled"};
}

/// The landscape's picture, painted in blocks on all processors.
Image paint_swatch(const Landscape& land,
                   float texel_m,
                   int side_px,
                   const std::function<bool(double)>& progress) {
  Image swatch(side_px, side_px, 3);
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  const int across = side_px / kBlockRows;
  for (int y = 0; y < side_px; y += kBlockRows) {
    std::atomic<int> next{0};
    const auto work = [&] {
      for (int i = next++; i < across; i = next++) {
        const Image block = paint_block(land, texel_m, i * kBlockRows, y, kBlockRows, kBlockRows);
        for (int row = 0; row < kBlockRows; ++row) {
          std::copy_n(&block.at(0, row), 3 * kBlockRows, &swatch.at(i * kBlockRows, y + row));
        }
      }
    };
    work_with_helpers(processors - 1, work);
    if (progress && !progress(static_cast<double>(y + kBlockRows) / side_px)) return {};
  }
  return swatch;
}

/// A row of the swatch and its mirror image.
void copy_mirrored(const Image& swatch, int y, std::uint8_t* row) {
  const int side = swatch.width_px;
  std::copy_n(&swatch.at(0, y), 3 * side, row);
  for (int x = 0; x < side; ++x) {
    std::copy_n(&swatch.at(x, y), 3, row + 3 * (2 * side - 1 - x));
  }
}

std::string level_name(int level) {
  return level == 0 ? "imagery.vrt" : "imagery_" + std::to_string(1 << level) + ".vrt";
}

/// One level of the mosaic in GDAL's virtual format.
std::string mosaic_text(
    const fs::path& ground, const Strip& strip, const std::string& wkt, int period_px, int level) {
  const int width = strip.width_px >> level;
  const int height = strip.height_px >> level;
  const int period = period_px >> level;
  char line[512];
  std::snprintf(line,
                sizeof(line),
                "<VRTDataset rasterXSize=\"%d\" rasterYSize=\"%d\">\n  <GeoTransform>%.10g, %.10g, "
                "0, %.10g, 0, %.10g</GeoTransform>\n",
                width,
                height,
                strip.left_x_m,
                strip.texel_m * (1 << level),
                strip.top_y_m,
                -strip.texel_m * (1 << level));
  std::string text = line;
  text += "  <SRS>" + wkt + "</SRS>\n";
  const char* const colours[] = {"Red", "Green", "Blue"};
  for (int band = 1; band <= 3; ++band) {
    text += "  <VRTRasterBand dataType=\"Byte\" band=\"" + std::to_string(band) +
            "\">\n    <ColorInterp>" + colours[band - 1] + "</ColorInterp>\n";
    for (int finer = 1; level == 0 && finer <= kStripOverviews; ++finer) {
      text += "    <Overview><SourceFilename relativeToVRT=\"1\">" + level_name(finer) +
              "</SourceFilename><SourceBand>" + std::to_string(band) + "</SourceBand></Overview>\n";
    }
    for (int y = 0; y < height; y += period) {
      for (int x = 0; x < width; x += period) {
        const int w = std::min(period, width - x);
        const int h = std::min(period, height - y);
        text += "    <SimpleSource><SourceFilename relativeToVRT=\"1\">" +
                ground.filename().string() + "</SourceFilename>";
        if (level > 0) {
          text += "<OpenOptions><OOI key=\"OVERVIEW_LEVEL\">" + std::to_string(level - 1) +
                  "</OOI></OpenOptions>";
        }
        std::snprintf(line,
                      sizeof(line),
                      "<SourceBand>%d</SourceBand><SourceProperties RasterXSize=\"%d\" "
                      "RasterYSize=\"%d\" DataType=\"Byte\" BlockXSize=\"256\" BlockYSize=\"256\"/>"
                      "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"%d\" ySize=\"%d\"/>"
                      "<DstRect xOff=\"%d\" yOff=\"%d\" xSize=\"%d\" ySize=\"%d\"/>"
                      "</SimpleSource>\n",
                      band,
                      period,
                      period,
                      w,
                      h,
                      x,
                      y,
                      w,
                      h);
        text += line;
      }
    }
    text += "  </VRTRasterBand>\n";
  }
  return text + "</VRTDataset>\n";
}

}  // namespace

Status write_ground(const fs::path& file,
                    const Landscape& land,
                    const Strip& strip,
                    int swatch_px,
                    const std::function<bool(double)>& progress) {
  const Image swatch = paint_swatch(land, static_cast<float>(strip.texel_m), swatch_px, progress);
  if (swatch.empty()) return strip_cancelled(file);
  const GdalMessages messages;
  const TiffSettings settings;
  const int side = 2 * swatch_px;
  auto dataset = create_jpeg_tiff(file, side, side, kStripOverviews);
  if (!dataset) return dataset.error();
  Status placed = place(**dataset, file, strip.site, strip.left_x_m, strip.top_y_m, strip.texel_m);
  if (!placed) return placed;
  LevelWriter writer(**dataset, kStripOverviews + 1);
  for (int y = 0; y < side; y += kBlockRows) {
    Image rows(side, kBlockRows, 3);
    for (int row = 0; row < kBlockRows; ++row) {
      const int from = y + row < swatch_px ? y + row : side - 1 - (y + row);
      copy_mirrored(swatch, from, &rows.at(0, row));
    }
    if (!writer.write(0, y, rows)) return io_error(file, messages);
    if (progress && !progress(1.0)) return strip_cancelled(file);
  }
  return {};
}

Status write_mosaic(const fs::path& folder,
                    const fs::path& ground,
                    const Strip& strip,
                    int swatch_px) {
  const std::string wkt = "EPSG:" + std::to_string(strip.site.epsg);
  for (int level = 0; level <= kStripOverviews; ++level) {
    const fs::path file = folder / level_name(level);
    std::ofstream out(file, std::ios::binary);
    out << mosaic_text(ground, strip, wkt, 2 * swatch_px, level);
    if (!out.flush()) return Error{ErrorCode::kIo, file.string() + ": cannot be written"};
  }
  return {};
}

Status write_hills(const fs::path& file,
                   const Strip& strip,
                   double post_m,
                   double relief_m,
                   std::uint32_t seed,
                   const std::function<bool(double)>& progress) {
  constexpr double kMarginM = 1000.0;
  constexpr double kLargestM = 1800.0;  ///< between hilltops
  const int columns =
      static_cast<int>((strip.width_px * strip.texel_m + 2.0 * kMarginM) / post_m) + 1;
  const int rows =
      static_cast<int>((strip.height_px * strip.texel_m + 2.0 * kMarginM) / post_m) + 1;
  auto dataset = create_height_tiff(file, columns, rows);
  if (!dataset) return dataset.error();
  // Posts are pixel centres: the raster's corner lies half a post beyond the outermost.
  Status placed = place(**dataset,
                        file,
                        strip.site,
                        strip.left_x_m - kMarginM - 0.5 * post_m,
                        strip.top_y_m + kMarginM + 0.5 * post_m,
                        post_m);
  if (!placed) return placed;
  constexpr int kStripRows = 256;
  for (int row = 0; row < rows; row += kStripRows) {
    const int count = std::min(kStripRows, rows - row);
    std::vector<float> posts(static_cast<std::size_t>(count) * columns);
    for (int v = 0; v < count; ++v) {
      const auto y = static_cast<float>((row + v) * post_m / kLargestM);
      for (int u = 0; u < columns; ++u) {
        const auto x = static_cast<float>(u * post_m / kLargestM);
        posts[static_cast<std::size_t>(v) * columns + u] = static_cast<float>(
            strip.site.base_height_m + 0.5 * relief_m * fractal(x, y, 5, 0.42F, seed));
      }
    }
    Status written = write_height_rows(**dataset, file, row, count, posts);
    if (!written) return written;
    if (progress && !progress(static_cast<double>(row) / rows)) return strip_cancelled(file);
  }
  return {};
}

}  // namespace overfly::terrain::synthesis
