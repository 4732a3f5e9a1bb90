#include "terrain/gdal_dataset.hpp"

#include <cpl_conv.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "core/file_text.hpp"
#include "terrain/crs_text.hpp"
#include "terrain/file_soundness.hpp"
#include "terrain/outside_access.hpp"
#include "terrain/regular_files.hpp"
#include "terrain/side_cars.hpp"
#include "terrain/virtual_raster.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;

void initialise_gdal() {
  static const bool done = [] {
    GDALAllRegister();
    close_outside_access();
    show_regular_files_alone();
    constexpr GIntBig kBlockCacheBytes = GIntBig{128} << 20;
    GDALSetCacheMax64(kBlockCacheBytes);
    // Side-car files of one directory listing per open cost more than they bring.
    CPLSetConfigOption("GDAL_PAM_ENABLED", "YES");
    return true;
  }();
  (void)done;
}

namespace {

/// The one that hears what is said on this thread.
GdalMessages*& innermost() {
  thread_local GdalMessages* messages = nullptr;
  return messages;
}

}  // namespace

GdalMessages::GdalMessages() : outer_(innermost()) {
  innermost() = this;
  CPLPushErrorHandlerEx(&GdalMessages::collect, this);
}

GdalMessages::~GdalMessages() {
  CPLPopErrorHandler();
  innermost() = outer_;
}

void CPL_STDCALL GdalMessages::collect(CPLErr severity, CPLErrorNum, const char* message) {
  if (severity < CE_Warning) return;
  static_cast<GdalMessages*>(CPLGetErrorHandlerUserData())->add(message);
}

void GdalMessages::add(std::string line) {
  constexpr std::size_t kLongest = 600;
  if (text_.size() > kLongest) return;
  std::replace(line.begin(), line.end(), '\n', ' ');
  while (!line.empty() && line.back() == ' ') line.pop_back();
  if (text_.find(line) != std::string::npos) return;
  if (!text_.empty()) text_ += "; ";
  text_ += line;
}

void GdalMessages::pass_on() const {
  if (outer_ != nullptr && !text_.empty()) outer_->add(text_);
}

std::string GdalMessages::text() const { return text_.empty() ? "no reason given" : text_; }

namespace {

/// A file may say that its overviews lie in another one, wherever that is.
Status check_overviews(GDALDataset& dataset, const fs::path& file) {
  const char* named = dataset.GetMetadataItem("OVERVIEW_FILE", "OVERVIEWS");
  if (named == nullptr) return {};
  std::string name = named;
  const std::string beside = ":::BASE:::";  // GDAL's mark of the file's own folder
  if (name.starts_with(beside)) name = name.substr(beside.size());
  if (name.find('/') == std::string::npos && name.find(':') == std::string::npos) return {};
  return Error{ErrorCode::kUnreadable, file.string() + ": names overviews outside of its folder"};
}

}  // namespace

Result<DatasetPtr> open_raster(const fs::path& file, int level) {
  initialise_gdal();
  if (Status status = check_regular_file(file); !status) return status.error();
  std::error_code ignored;
  if (fs::file_size(file, ignored) == 0) {
    return Error{ErrorCode::kUnreadable, file.string() + ": is empty (0 bytes)"};
  }
  if (Status status = check_virtual_raster(file); !status) return status.error();
  GdalMessages messages;
  CPLStringList options;
  if (level > 0) options.SetNameValue("OVERVIEW_LEVEL", std::to_string(level - 1).c_str());
  DatasetPtr dataset(GDALDataset::Open(
      fs::absolute(file).c_str(),  // begins with a slash: no name that GDAL has a meaning for
      GDAL_OF_RASTER | GDAL_OF_READONLY,
      nullptr,
      options.List(),
      nullptr));
  if (!dataset) {
    std::string reason = messages.text();
    for (const std::string& doubt : SideCars().doubts(file)) reason += "; " + doubt;
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": not a raster that can be read: " + reason};
  }
  if (dataset->GetRasterCount() < 1) {
    return Error{ErrorCode::kUnreadable, file.string() + ": has no raster band"};
  }
  if (Status status = check_overviews(*dataset, file); !status) return status.error();
  messages.pass_on();
  return dataset;
}

std::string heard_while_opening(const fs::path& file, const GdalMessages& messages) {
  return file.string() + ": opening it, GDAL said: " + messages.text();
}

namespace {

/// Handles that wait in all pools together.
std::atomic<int>& idle_handles() {
  static std::atomic<int> count{0};
  return count;
}

}  // namespace

DatasetPool::DatasetPool(fs::path file, int level, DatasetPtr first)
    : file_(std::move(file)), level_(level), identity_(file_identity(file_)) {
  if (!first) return;
  idle_.push_back(std::move(first));
  ++idle_handles();
}

Result<DatasetPtr> DatasetPool::take() {
  const auto now = file_identity(file_);
  const bool there = now && identity_ && now->same_file(*identity_);
  if (there && !now->same_content(*identity_)) {
    return Error{ErrorCode::kIo, file_.string() + ": was written to while it was in use"};
  }
  std::unique_lock lock(mutex_);
  if (!there && in_use_ > 0) {
    constexpr std::chrono::seconds kPatience{2};
    returned_.wait_for(lock, kPatience, [this] { return !idle_.empty(); });
  }
  if (idle_.empty() && !there) {
    return Error{ErrorCode::kIo,
                 file_.string() + (now ? ": was replaced while it was in use"
                                       : ": is gone; it was there when the world was opened")};
  }
  ++in_use_;
  if (idle_.empty()) {
    lock.unlock();
    return open_another();
  }
  DatasetPtr dataset = std::move(idle_.back());
  idle_.pop_back();
  --idle_handles();
  return dataset;
}

Result<DatasetPtr> DatasetPool::open_another() {
  Result<DatasetPtr> opened = open_raster(file_, level_);
  if (opened) return opened;
  const std::lock_guard lock(mutex_);
  --in_use_;
  // What was readable before and is not now is a fault of reading, whatever GDAL finds.
  return Error{ErrorCode::kIo, opened.error().message};
}

void DatasetPool::put(DatasetPtr dataset) {
  // A world of a thousand files must not use up the process's file descriptors.
  constexpr int kMostIdle = 400;
  const std::lock_guard lock(mutex_);
  --in_use_;
  if (idle_handles() >= kMostIdle) return;
  ++idle_handles();
  idle_.push_back(std::move(dataset));
  returned_.notify_one();
}

DatasetPool::~DatasetPool() { idle_handles() -= static_cast<int>(idle_.size()); }

void GeoTransform::crs_from_pixel(double px, double py, double& x, double& y) const {
  x = g[0] + g[1] * px + g[2] * py;
  y = g[3] + g[4] * px + g[5] * py;
}

void GeoTransform::pixel_from_crs(double x, double y, double& px, double& py) const {
  const double determinant = g[1] * g[5] - g[2] * g[4];
  const double dx = x - g[0];
  const double dy = y - g[3];
  px = (g[5] * dx - g[2] * dy) / determinant;
  py = (g[1] * dy - g[4] * dx) / determinant;
}

namespace {

/// Corner coordinates that no place on earth has betray a transform and a CRS that do not match.
Status check_range(const Georeference& place, int width, int height, const std::string& file) {
  for (int corner = 0; corner < 4; ++corner) {
    double x = 0.0;
    double y = 0.0;
    place.transform.crs_from_pixel((corner & 1) * width, (corner >> 1) * height, x, y);
    const bool geographic = place.crs.IsGeographic() != 0;
    const double unit = geographic ? place.crs.GetAngularUnits() : place.crs.GetLinearUnits();
    constexpr double kTolerance = 1e-3;
    const double limit_x = geographic ? 2.0 * M_PI + kTolerance : 5e7;
    const double limit_y = geographic ? 0.5 * M_PI + kTolerance : 5e7;
    if (!(std::abs(x * unit) <= limit_x) || !(std::abs(y * unit) <= limit_y)) {
      return Error{ErrorCode::kInvalidArgument,
                   file + ": georeference is broken: a corner lies at (" + std::to_string(x) +
                       ", " + std::to_string(y) + "), outside its coordinate reference system"};
    }
  }
  return {};
}

}  // namespace

Result<Georeference> read_georeference(GDALDataset& dataset,
                                       const fs::path& file,
                                       const std::optional<std::string>& crs_override,
                                       const std::string& said) {
  const std::string heard = said.empty() ? "" : " (GDAL said: " + said + ")";
  Georeference place;
  if (dataset.GetGeoTransform(place.transform.g) != CE_None) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": has no georeference (no position and pixel size)" + heard};
  }
  const double* g = place.transform.g;
  if (const double area = g[1] * g[5] - g[2] * g[4]; !std::isfinite(area) || area == 0.0) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": georeference is degenerate: pixel size (" +
                     std::to_string(g[1]) + ", " + std::to_string(g[5]) + ")"};
  }
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  if (crs != nullptr && !crs->IsEmpty()) {
    place.crs = *crs;
  } else if (crs_override) {
    if (Status status = check_crs_text(*crs_override, file.string() + ": crs"); !status) {
      return status.error();
    }
    const GdalMessages messages;
    if (place.crs.SetFromUserInput(crs_override->c_str(),
                                   OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
        OGRERR_NONE) {
      return Error{ErrorCode::kInvalidArgument,
                   file.string() + ": crs = \"" + *crs_override +
                       "\" is not a known coordinate reference system: " + messages.text()};
    }
  } else {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": has no coordinate reference system" + heard +
                     "; say it in the manifest's field \"crs\", for example \"EPSG:4326\""};
  }
  if (place.crs.IsProjected() == 0 && place.crs.IsGeographic() == 0) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() +
                     ": coordinate reference system is neither projected nor "
                     "geographic, so its place on the earth is unknown"};
  }
  place.crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const Status in_range =
      check_range(place, dataset.GetRasterXSize(), dataset.GetRasterYSize(), file.string());
  if (!in_range) return in_range.error();
  const Status sized = check_pixel_size(place, file.string());
  if (!sized) return sized.error();
  return place;
}

}  // namespace overfly::terrain
