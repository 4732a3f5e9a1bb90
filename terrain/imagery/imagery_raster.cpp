#include "terrain/imagery/imagery_raster.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <list>

#include "core/barrier.hpp"
#include "terrain/place/datum_shift.hpp"
#include "terrain/place/place_doubt.hpp"
#include "terrain/raster/file_soundness.hpp"

namespace overfly::terrain {
namespace {

/// Maximum number of texels of the finest in-memory level of one file (16 MB).
constexpr double kPyramidTexels = 4.0 * 1024 * 1024;
/// For all files together.
constexpr std::size_t kPyramidBytes = std::size_t{384} << 20U;

/// Keeps the most recently used coarse levels of all files; the others are computed again on
/// demand.
class KeptLevels {
 public:
  void keep(const std::shared_ptr<const std::vector<Patch>>& levels) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find(kept_.begin(), kept_.end(), levels);
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
      return;
    }
    kept_.push_front(levels);
    bytes_ += bytes_of(*levels);
    while (bytes_ > kPyramidBytes && kept_.size() > 1) {
      bytes_ -= bytes_of(*kept_.back());
      kept_.pop_back();
    }
  }

 private:
  static std::size_t bytes_of(const std::vector<Patch>& levels) {
    std::size_t bytes = 0;
    for (const Patch& level : levels) bytes += level.rgb.data.size() + level.valid.data.size();
    return bytes;
  }
  std::mutex mutex_;
  std::list<std::shared_ptr<const std::vector<Patch>>> kept_;
  std::size_t bytes_ = 0;
};

KeptLevels& kept_levels() {
  static KeptLevels kept;
  return kept;
}

int ceil_div(int a, int b) { return (a + b - 1) / b; }

/// A description of a few bytes may declare any size. Numbers of texels along a side are computed
/// as int, also after rounding up to a power of two.
Status check_raster_size(GDALDataset& dataset, const std::filesystem::path& file) {
  constexpr int kMostSidePx = 1 << 30;
  constexpr double kMostTexels = 1e13;
  const int width = dataset.GetRasterXSize();
  const int height = dataset.GetRasterYSize();
  if (width <= kMostSidePx && height <= kMostSidePx &&
      static_cast<double>(width) * height <= kMostTexels) {
    return {};
  }
  return Error{ErrorCode::kUnreadable,
               file.string() + ": " + std::to_string(width) + " x " + std::to_string(height) +
                   " texels: must be at most " + std::to_string(kMostSidePx) +
                   " along a side and 1e13 in all"};
}

}  // namespace

Result<std::shared_ptr<ImageryRaster>> ImageryRaster::open(const ImageryLayer& layer,
                                                           const Cancelled& cancelled,
                                                           std::vector<std::string>& warnings) {
  const std::filesystem::path& file = layer.file;
  auto raster = std::make_shared<ImageryRaster>();
  raster->file_ = file;
  initialise_gdal();
  GdalMessages messages;
  auto opened = open_raster(file);
  if (!opened) return opened.error();
  GDALDataset& dataset = **opened;
  if (Status sized = check_raster_size(dataset, file); !sized) return sized.error();
  raster->width_px_ = dataset.GetRasterXSize();
  raster->height_px_ = dataset.GetRasterYSize();
  raster->format_ = dataset.GetDriver()->GetDescription();
  auto place = read_georeference(
      dataset, file, layer.crs, messages.empty() ? std::string() : messages.text());
  if (!place) return place.error();
  raster->georeference_ = *place;
  Eigen::Vector2d middle;
  place->transform.crs_from_pixel(
      0.5 * raster->width_px_, 0.5 * raster->height_px_, middle.x(), middle.y());
  if (auto doubt = datum_shift_doubt(place->crs, middle.x(), middle.y(), file.string())) {
    warnings.push_back(std::move(*doubt));
  }
  if (auto doubt = place_doubt(*place, raster->width_px_, raster->height_px_, file.string())) {
    warnings.push_back(std::move(*doubt));
  }
  auto bands = find_bands(dataset, file.string(), layer.nodata, layer.range, cancelled);
  if (!bands) return bands.error();
  raster->bands_ = *bands;
  if (!messages.empty()) warnings.push_back(heard_while_opening(file, messages));
  Stored base;
  base.width_px = raster->width_px_;
  base.height_px = raster->height_px_;
  base.pool = std::make_unique<DatasetPool>(file, 0, std::move(*opened));
  raster->pyramid_->stored.push_back(std::move(base));
  return raster;
}

Status ImageryRaster::prepare(const Cancelled& cancelled) const {
  std::call_once(pyramid_->prepared, [&] { pyramid_->state = look_at_blocks(cancelled); });
  return pyramid_->state;
}

Status ImageryRaster::look_at_blocks(const Cancelled& cancelled) const {
  const GdalMessages quiet;
  auto dataset = pyramid_->stored.front().pool->take();
  if (!dataset) return dataset.error();
  Status whole = check_whole(**dataset, file_, cancelled, pyramid_->doubts);
  if (whole) whole = add_overviews(**dataset, cancelled);
  if (!whole) return whole;
  const auto on_the_way = rows_on_the_way(*(*dataset)->GetRasterBand(bands_.rgb[0]));
  pyramid_->stored.front().pool->put(std::move(*dataset));
  Status sampled = look_for_a_picture(on_the_way, cancelled);
  if (!sampled) return sampled;
  // The in-memory levels start after the stored ones, or later if they would be too large.
  int& level = pyramid_->first_level;
  level = pyramid_->stored.back().level + 2;
  const double texels = static_cast<double>(width_px_) * height_px_;
  while (texels / std::pow(4.0, level) > kPyramidTexels) ++level;
  return {};
}

std::vector<std::string> ImageryRaster::doubts() const {
  std::vector<std::string> all = pyramid_->doubts;
  const Stored& coarsest = pyramid_->stored.back();
  const double texels = static_cast<double>(coarsest.width_px) * coarsest.height_px;
  constexpr double kMany = 256e6;
  if (texels >= kMany) {
    all.push_back(file_.string() + ": has no area-averaged overviews below " +
                  std::to_string(coarsest.width_px) + " x " + std::to_string(coarsest.height_px) +
                  " px: distant views read " + std::to_string(static_cast<long>(texels / 1e6)) +
                  " million texels; `overfly world build` avoids that");
  }
  return all;
}

/// Tiles without data at a service are often of one colour, without a mask.
Status ImageryRaster::look_for_a_picture(const std::vector<int>& rows_on_the_way,
                                         const Cancelled& cancelled) const {
  const auto texel_at = [&](int x, int y) -> Result<Patch> {
    if (Status status = go_on(cancelled, file_); !status) return status.error();
    return read_stored(pyramid_->stored.front(), x, y, 1, 1);
  };
  std::optional<std::array<std::uint8_t, 3>> first;
  // A few samples are enough for nearly every file; more are taken before a warning.
  for (const int steps : {5, 32}) {
    auto on_the_way = rows_on_the_way.begin();
    for (int i = 0; i < steps * steps; ++i) {
      const int column = i % steps;
      const int row = i / steps;
      const auto x = static_cast<int>((column + 0.5) / steps * width_px_);
      const auto y = static_cast<int>((row + 0.5) / steps * height_px_);
      for (; on_the_way != rows_on_the_way.end() && *on_the_way < y; ++on_the_way) {
        if (const auto passed = texel_at(0, *on_the_way); !passed) return passed.error();
      }
      const auto texel = texel_at(x, y);
      if (!texel) return texel.error();
      if (texel->valid.data[0] == 0) return {};  // a mask marks missing data
      const auto& rgb = texel->rgb.data;
      if (!first) first = {rgb[0], rgb[1], rgb[2]};
      if (!std::equal(first->begin(), first->end(), rgb.begin())) return {};
    }
  }
  pyramid_->doubts.push_back(file_.string() + ": all of 1024 samples have one colour (" +
                             std::to_string((*first)[0]) + ", " + std::to_string((*first)[1]) +
                             ", " + std::to_string((*first)[2]) + "); is it an empty tile?");
  return {};
}

Status ImageryRaster::add_overviews(GDALDataset& dataset, const Cancelled& cancelled) const {
  // Overviews contain averages of written and unwritten blocks.
  if (bands_.unwritten) return {};
  std::vector<Stored>& all = pyramid_->stored;
  GDALRasterBand* band = dataset.GetRasterBand(bands_.rgb[0]);
  for (int i = 0; i < band->GetOverviewCount(); ++i) {
    GDALRasterBand* overview = band->GetOverview(i);
    if (overview == nullptr) continue;
    Stored stored;
    stored.width_px = overview->GetXSize();
    stored.height_px = overview->GetYSize();
    stored.ratio_x = static_cast<double>(width_px_) / stored.width_px;
    stored.ratio_y = static_cast<double>(height_px_) / stored.height_px;
    stored.level = static_cast<int>(std::lround(std::log2(stored.ratio_x)));
    const double power = std::pow(2.0, stored.level);
    const bool power_of_two = std::abs(stored.ratio_x / power - 1.0) < 0.02 &&
                              std::abs(stored.ratio_y / power - 1.0) < 0.02;
    if (!power_of_two || stored.level <= all.back().level) continue;
    stored.pool = std::make_unique<DatasetPool>(file_, i + 1);
    // Coarse tiles are then computed again, which only costs time.
    const auto average = overview_is_average(all.back(), stored, cancelled);
    if (!average) return average.error();
    if (!*average) return {};
    all.push_back(std::move(stored));
  }
  return {};
}

/// Errors: kCancelled.
Result<bool> ImageryRaster::overview_is_average(const Stored& finer,
                                                const Stored& coarser,
                                                const Cancelled& cancelled) const {
  const double step_x = static_cast<double>(finer.width_px) / coarser.width_px;
  const double step_y = static_cast<double>(finer.height_px) / coarser.height_px;
  constexpr int kWindow = 48;
  const int width = std::min(kWindow, coarser.width_px);
  const int height = std::min(kWindow, coarser.height_px);
  double to_average = 0.0;
  double to_nearest = 0.0;
  for (int place = 0; place < 5; ++place) {
    if (Status status = go_on(cancelled, file_); !status) return status.error();
    const int x = static_cast<int>((coarser.width_px - width) * (0.1 + 0.2 * place));
    const int y = static_cast<int>((coarser.height_px - height) * (0.9 - 0.17 * place));
    const int fine_x = static_cast<int>(x * step_x);
    const int fine_y = static_cast<int>(y * step_y);
    const int fine_width =
        std::min(finer.width_px - fine_x, static_cast<int>(std::ceil(width * step_x)) + 2);
    const int fine_height =
        std::min(finer.height_px - fine_y, static_cast<int>(std::ceil(height * step_y)) + 2);
    const auto fine = read_stored(finer, fine_x, fine_y, fine_width, fine_height);
    const auto coarse = read_stored(coarser, x, y, width, height);
    if (!fine || !coarse) return false;
    const Patch average = area_average(
        *fine, x * step_x - fine_x, step_x, y * step_y - fine_y, step_y, width, height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        if (average.valid.at(u, v) == 0 || coarse->valid.at(u, v) == 0) continue;
        const int px = std::min(fine_width - 1, static_cast<int>((x + u + 0.5) * step_x) - fine_x);
        const int py = std::min(fine_height - 1, static_cast<int>((y + v + 0.5) * step_y) - fine_y);
        const double mean = average.rgb.at(u, v, 1);
        to_average += std::pow(coarse->rgb.at(u, v, 1) - mean, 2.0);
        to_nearest += std::pow(fine->rgb.at(px, py, 1) - mean, 2.0);
      }
    }
  }
  // Compression keeps an average within a few grey levels of ours; a nearest-neighbour overview
  // differs by as much as single texels do.
  constexpr double kShare = 0.35;
  const double noise = 3.5 * 3.5 * 5 * width * height;
  return to_average <= std::max(noise, kShare * to_nearest);
}

Result<Patch> ImageryRaster::read_stored(
    const Stored& stored, int x, int y, int width, int height) const {
  const int left = std::max(0, x);
  const int top = std::max(0, y);
  const int right = std::min(stored.width_px, x + width);
  const int bottom = std::min(stored.height_px, y + height);
  if (right <= left || bottom <= top) return void_patch(width, height);
  auto dataset = stored.pool->take();
  if (!dataset) return dataset.error();
  auto inside =
      read_bands(**dataset, bands_, file_.string(), left, top, right - left, bottom - top);
  stored.pool->put(std::move(*dataset));
  if (!inside || (right - left == width && bottom - top == height)) return inside;
  Patch patch = void_patch(width, height);
  for (int row = top; row < bottom; ++row) {
    const std::size_t count = static_cast<std::size_t>(right - left);
    const std::size_t from = static_cast<std::size_t>(row - top) * count;
    const std::size_t to = static_cast<std::size_t>(row - y) * width + (left - x);
    std::copy_n(inside->rgb.data.begin() + static_cast<std::ptrdiff_t>(3 * from),
                3 * count,
                patch.rgb.data.begin() + static_cast<std::ptrdiff_t>(3 * to));
    std::copy_n(inside->valid.data.begin() + static_cast<std::ptrdiff_t>(from),
                count,
                patch.valid.data.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return patch;
}

/// The coarsest stored texels from which a level can be computed: the level itself if it is exact,
/// else texels of at most half its size, so that their shifts average out.
const ImageryRaster::Stored& ImageryRaster::source_for(int level) const {
  const Stored* best = &pyramid_->stored.front();
  for (const Stored& stored : pyramid_->stored) {
    if (stored.level <= (stored.exact() ? level : level - 1)) best = &stored;
  }
  return *best;
}

Result<Patch> ImageryRaster::read_averaged(
    const Stored& stored, int level, int x, int y, int width, int height) const {
  const double step_x = std::pow(2.0, level) / stored.ratio_x;
  const double step_y = std::pow(2.0, level) / stored.ratio_y;
  const int first_x = static_cast<int>(std::floor(x * step_x));
  const int first_y = static_cast<int>(std::floor(y * step_y));
  const int last_x = static_cast<int>(std::ceil((x + width) * step_x));
  const int last_y = static_cast<int>(std::ceil((y + height) * step_y));
  auto fine = read_stored(stored, first_x, first_y, last_x - first_x, last_y - first_y);
  if (!fine) return fine;
  return area_average(
      *fine, x * step_x - first_x, step_x, y * step_y - first_y, step_y, width, height);
}

Result<ImageryRaster::Levels> ImageryRaster::make_levels(const Cancelled& cancelled) const {
  const int level = pyramid_->first_level;
  const Stored& source = source_for(level);
  Patch first = void_patch(ceil_div(width_px_, 1 << level), ceil_div(height_px_, 1 << level));
  // Parts that need about 16 MB of source texels, in the order of the file's rows.
  const int step = 1 << std::max(0, level - source.level);
  const int columns = std::max(1, 8192 / step);
  const int rows = std::max(1, 512 / step);
  for (int y = 0; y < first.rgb.height_px; y += rows) {
    if (Status status = go_on(cancelled, file_); !status) return status.error();
    for (int x = 0; x < first.rgb.width_px; x += columns) {
      const int width = std::min(columns, first.rgb.width_px - x);
      const int height = std::min(rows, first.rgb.height_px - y);
      auto piece = read_averaged(source, level, x, y, width, height);
      if (!piece) return piece.error();
      for (int v = 0; v < height; ++v) {
        std::copy_n(&piece->rgb.at(0, v), 3 * width, &first.rgb.at(x, y + v));
        std::copy_n(&piece->valid.at(0, v), width, &first.valid.at(x, y + v));
      }
    }
  }
  Levels levels;
  levels.push_back(std::move(first));
  while (levels.back().rgb.width_px > 1 || levels.back().rgb.height_px > 1) {
    const Patch& finest = levels.back();
    Patch next = area_average(finest,
                              0.0,
                              2.0,
                              0.0,
                              2.0,
                              ceil_div(finest.rgb.width_px, 2),
                              ceil_div(finest.rgb.height_px, 2));
    levels.push_back(std::move(next));
  }
  return levels;
}

Result<std::shared_ptr<const ImageryRaster::Levels>> ImageryRaster::coarse_levels(
    const Cancelled& cancelled) const {
  constexpr std::chrono::milliseconds kLookEvery{20};
  std::unique_lock lock(pyramid_->mutex);
  while (pyramid_->making) {
    pyramid_->made.wait_for(lock, kLookEvery);
    if (Status status = go_on(cancelled, file_); !status) return status.error();
  }
  std::shared_ptr<const Levels> levels = pyramid_->levels.lock();
  if (!levels) {
    pyramid_->making = true;
    lock.unlock();
    auto made = guarded([&] { return make_levels(cancelled); });
    lock.lock();
    pyramid_->making = false;
    pyramid_->made.notify_all();
    if (!made) return made.error();
    levels = std::make_shared<const Levels>(std::move(*made));
    pyramid_->levels = levels;
  }
  kept_levels().keep(levels);
  return levels;
}

Result<Patch> ImageryRaster::read(
    int level, int x, int y, int width, int height, const Cancelled& cancelled) const {
  const Status prepared = prepare();
  if (!prepared) return prepared.error();
  const Stored& stored = source_for(level);
  if (stored.level == level && stored.exact()) return read_stored(stored, x, y, width, height);
  if (level < pyramid_->first_level) return read_averaged(stored, level, x, y, width, height);
  auto levels = coarse_levels(cancelled);
  if (!levels) return levels.error();
  const std::size_t index =
      std::min<std::size_t>(level - pyramid_->first_level, (*levels)->size() - 1);
  const Patch& whole = (**levels)[index];
  Patch patch = void_patch(width, height);
  for (int v = std::max(0, -y); v < std::min(height, whole.rgb.height_px - y); ++v) {
    for (int u = std::max(0, -x); u < std::min(width, whole.rgb.width_px - x); ++u) {
      for (int c = 0; c < 3; ++c) patch.rgb.at(u, v, c) = whole.rgb.at(x + u, y + v, c);
      patch.valid.at(u, v) = whole.valid.at(x + u, y + v);
    }
  }
  return patch;
}

}  // namespace overfly::terrain
