// ElevationRaster: conversion of the file's numbers to heights.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "terrain/elevation/elevation_raster.hpp"

namespace overfly::terrain {
namespace {

/// Reads every step-th pixel of a row and of a column, as GDAL chooses them, but from no overview.
/// @param data  rows of `stride` values
template <typename Value>
CPLErr read_thinned(GDALRasterBand& band,
                    int first_column,
                    int first_row,
                    int columns,
                    int rows,
                    int step,
                    Value* data,
                    int stride,
                    GDALDataType type) {
  const int width = columns * step;
  std::vector<Value> pixels(static_cast<std::size_t>(width));
  for (int j = 0; j < rows; ++j) {
    const int row = first_row + j * step + step / 2;
    const CPLErr outcome = band.RasterIO(
        GF_Read, first_column, row, width, 1, pixels.data(), width, 1, type, 0, 0, nullptr);
    if (outcome != CE_None) return outcome;
    for (int i = 0; i < columns; ++i) {
      data[static_cast<std::size_t>(j) * stride + i] =
          pixels[static_cast<std::size_t>(i) * step + step / 2];
    }
  }
  return CE_None;
}

}  // namespace

/// Posts as in the file; NaN if its mask or its declared value marks them as no data.
Result<HeightGrid> ElevationRaster::read_numbers(int column, int row, int columns, int rows) const {
  HeightGrid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.heights_m.resize(static_cast<std::size_t>(columns) * rows);
  auto dataset = pool_->take();
  if (!dataset) return dataset.error();
  const GdalMessages messages;
  GDALRasterBand* band = (*dataset)->GetRasterBand(1);
  const auto read_into = [&](GDALRasterBand* from, auto* data, GDALDataType type) {
    CPLErr outcome = CE_None;
    // In one read, unless the window continues beyond the last of the columns around the earth.
    for (int done = 0, count = 0; done < columns && outcome == CE_None; done += count) {
      int first = window_.column + column + done;
      count = columns - done;
      if (columns_around_) {
        first = (first % *columns_around_ + *columns_around_) % *columns_around_;
        count = std::min(count, *columns_around_ - first);
      }
      if (step_ > 1 && !has_overviews_) {
        outcome = read_thinned(*from,
                               first * step_,
                               (window_.row + row) * step_,
                               count,
                               rows,
                               step_,
                               data + done,
                               columns,
                               type);
        continue;
      }
      outcome = from->RasterIO(GF_Read,
                               first * step_,
                               (window_.row + row) * step_,
                               count * step_,
                               rows * step_,
                               data + done,
                               count,
                               rows,
                               type,
                               0,
                               static_cast<GSpacing>(sizeof(*data)) * columns,
                               nullptr);
    }
    return outcome;
  };
  CPLErr outcome = read_into(band, grid.heights_m.data(), GDT_Float32);
  std::vector<std::uint8_t> mask;
  if (outcome == CE_None && masked_) {
    mask.resize(grid.heights_m.size());
    outcome = read_into(band->GetMaskBand(), mask.data(), GDT_Byte);
  }
  pool_->put(std::move(*dataset));
  if (outcome != CE_None) {
    return Error{ErrorCode::kIo, file_ + ": heights cannot be read: " + messages.text()};
  }
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) grid.heights_m[i] = kNone;
  }
  if (nodata_) {
    const auto nodata = static_cast<float>(*nodata_);
    std::replace(grid.heights_m.begin(), grid.heights_m.end(), nodata, kNone);
  }
  return grid;
}

Result<RawPosts> ElevationRaster::read(int column, int row, int columns, int rows) const {
  auto numbers = read_numbers(column, row, columns, rows);
  if (!numbers) return numbers.error();
  RawPosts posts{std::move(*numbers), 0};
  voids_.erase_from(posts.grid, column, row);
  to_metres(posts, column, row);
  return posts;
}

/// The height of a number above its own datum; NaN for implausible values.
double ElevationRaster::metres_of(float number) const {
  constexpr double kLowestM = -12000.0;
  constexpr double kHighestM = 9000.0;
  const double metres = number * scale_m_ + offset_m_;
  return metres >= kLowestM && metres <= kHighestM ? metres
                                                   : std::numeric_limits<double>::quiet_NaN();
}

/// Converts numbers to metres above the ellipsoid.
void ElevationRaster::to_metres(RawPosts& posts, int column, int row) const {
  bool usual_void = false;
  for (float& height : posts.grid.heights_m) {
    if (std::isnan(height)) continue;
    usual_void = usual_void || is_usual_void(height);
    height = static_cast<float>(metres_of(height));
    if (std::isnan(height)) ++posts.implausible;
  }
  if (usual_void) usual_void_seen_ = true;
  if (separation_m_.columns == 0) return;
  const double step_u = (separation_m_.columns - 1.0) / std::max(1, window_.columns - 1);
  const double step_v = (separation_m_.rows - 1.0) / std::max(1, window_.rows - 1);
  for (int j = 0; j < posts.grid.rows; ++j) {
    for (int i = 0; i < posts.grid.columns; ++i) {
      posts.grid.at(i, j) +=
          static_cast<float>(separation_m_.bilinear((column + i) * step_u, (row + j) * step_v));
    }
  }
}

Result<bool> ElevationRaster::find_undeclared_voids(const Cancelled& cancelled) {
  if (trusted_ || !usual_void_seen_) return false;
  constexpr int kStripPosts = 1 << 20;
  const int strip_rows = std::clamp(kStripPosts / window_.columns, 1, window_.rows);
  VoidPlateaus plateaus(window_.columns, spacing_m_);
  std::vector<float> heights(static_cast<std::size_t>(window_.columns));
  for (int top = 0; top < window_.rows; top += strip_rows) {
    if (Status status = go_on(cancelled, file_); !status) return status.error();
    const auto strip =
        read_numbers(0, top, window_.columns, std::min(strip_rows, window_.rows - top));
    if (!strip) return strip.error();
    for (int j = 0; j < strip->rows; ++j) {
      const float* const row =
          strip->heights_m.data() + static_cast<std::ptrdiff_t>(j) * strip->columns;
      std::transform(row, row + strip->columns, heights.begin(), [this](float number) {
        return static_cast<float>(metres_of(number));
      });
      plateaus.add_row(row, heights.data());
    }
  }
  voids_ = plateaus.finish();
  page_posts(cache_);  // because cached blocks contain the posts as they were
  return !voids_.runs.empty();
}

Result<HeightGrid> ElevationRaster::posts_block(int column, int row) const {
  const int left = column * kBlockPosts;
  const int top = row * kBlockPosts;
  auto read = this->read(left,
                         top,
                         std::min(kBlockPosts + 1, window_.columns - left),
                         std::min(kBlockPosts + 1, window_.rows - top));
  if (!read) return read.error();
  if (read->implausible > 0) implausible_ = true;
  if (read->grid.columns > kBlockPosts && read->grid.rows > kBlockPosts) {
    return std::move(read->grid);
  }
  HeightGrid block;
  block.columns = kBlockPosts + 1;
  block.rows = kBlockPosts + 1;
  block.heights_m.resize(static_cast<std::size_t>(block.columns) * block.rows);
  for (int j = 0; j < block.rows; ++j) {
    for (int i = 0; i < block.columns; ++i) {
      block.at(i, j) =
          read->grid.at(std::min(i, read->grid.columns - 1), std::min(j, read->grid.rows - 1));
    }
  }
  return block;
}

}  // namespace overfly::terrain
