#include "terrain/synthesis/world_files.hpp"

#include <atomic>
#include <future>
#include <thread>

#include "core/helper_threads.hpp"
#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/synthesis/geotiff_writer.hpp"
#include "terrain/synthesis/landscape/painter.hpp"

namespace overfly::terrain::synthesis {
namespace fs = std::filesystem;
namespace {

/// Side of the blocks that are painted at a time.
constexpr int kPaintBlockPx = 512;
constexpr int kOverviews = 5;

/// Paints a row of blocks on all processors.
Image paint_strip(const Landscape& land, float texel_m, int side_px, int y, int height) {
  Image strip(side_px, height, 3);
  const int blocks = (side_px + kPaintBlockPx - 1) / kPaintBlockPx;
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int block = next++; block < blocks; block = next++) {
      const int x = block * kPaintBlockPx;
      const int width = std::min(kPaintBlockPx, side_px - x);
      const Image painted = paint_block(land, texel_m, x, y, width, height);
      for (int row = 0; row < height; ++row) {
        std::copy_n(&painted.at(0, row), 3 * width, &strip.at(x, row));
      }
    }
  };
  work_with_helpers(std::max(1U, std::thread::hardware_concurrency()) - 1, work);
  return strip;
}

}  // namespace

Status write_imagery(const fs::path& file,
                     const Landscape& land,
                     const Site& site,
                     double texel_m,
                     int side_px,
                     const std::function<bool(double)>& progress) {
  initialise_gdal();
  const GdalMessages messages;
  const TiffSettings settings;
  auto dataset = create_jpeg_tiff(file, side_px, side_px, kOverviews);
  if (!dataset) return dataset.error();
  const double half_m = 0.5 * side_px * texel_m;
  const Status placed =
      place(**dataset, file, site, site.middle_x_m - half_m, site.middle_y_m + half_m, texel_m);
  if (!placed) return placed.error();

  LevelWriter writer(**dataset, kOverviews + 1);
  std::future<bool> writing;
  for (int y = 0; y < side_px; y += kPaintBlockPx) {
    const int height = std::min(kPaintBlockPx, side_px - y);
    Image strip = paint_strip(land, static_cast<float>(texel_m), side_px, y, height);
    if (writing.valid() && !writing.get()) return io_error(file, messages);
    if (progress && !progress(static_cast<double>(y) / side_px)) {
      return Error{ErrorCode::kCancelled, "synthesis of " + file.string() + " was cancelled"};
    }
    writing = std::async(std::launch::async, [&writer, y, painted = std::move(strip)] {
      const TiffSettings own;
      return writer.write(0, y, painted);
    });
  }
  if (writing.valid() && !writing.get()) return io_error(file, messages);
  return {};
}

Status write_heights(const fs::path& file, const Landscape& land, const Site& site) {
  const int side = land.relief.side_posts();
  // Posts are pixel centres: the raster's corner lies half a post beyond the outermost.
  const double half_m = land.relief.half_m() + 0.5 * Relief::kPostM;
  std::vector<float> posts = land.relief.heights_m();
  for (float& height : posts) height += static_cast<float>(site.base_height_m);
  auto dataset = create_height_tiff(file, side, side);
  if (!dataset) return dataset.error();
  const Status placed = place(
      **dataset, file, site, site.middle_x_m - half_m, site.middle_y_m + half_m, Relief::kPostM);
  if (!placed) return placed.error();
  return write_height_rows(**dataset, file, 0, side, posts);
}

}  // namespace overfly::terrain::synthesis
