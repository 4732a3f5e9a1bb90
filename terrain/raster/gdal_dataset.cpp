#include "terrain/raster/gdal_dataset.hpp"

#include <cpl_conv.h>

#include <atomic>
#include <chrono>
#include <cstdint>

#include "core/outside/file_text.hpp"
#include "terrain/files/outside_access.hpp"
#include "terrain/files/regular_files.hpp"
#include "terrain/files/side_cars.hpp"
#include "terrain/raster/img_files.hpp"
#include "terrain/raster/virtual_raster.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;

void initialise_gdal() {
  static const bool done = [] {
    GDALAllRegister();
    close_outside_access();
    show_regular_files_alone();
    restrict_virtual_rasters();
    restrict_img_files();
    constexpr GIntBig kBlockCacheBytes = GIntBig{128} << 20;
    GDALSetCacheMax64(kBlockCacheBytes);
    // Side-cars in XML (masks, statistics, places) are read, whatever the environment says.
    CPLSetConfigOption("GDAL_PAM_ENABLED", "YES");
    return true;
  }();
  (void)done;
}

namespace {

/// A file may declare that its overviews are in another file, in any place.
Status check_overviews(GDALDataset& dataset, const fs::path& file) {
  const char* named = dataset.GetMetadataItem("OVERVIEW_FILE", "OVERVIEWS");
  if (named == nullptr) return {};
  std::string name = named;
  const std::string own_folder = ":::BASE:::";  // GDAL's prefix for the folder of the file
  if (name.starts_with(own_folder)) name = name.substr(own_folder.size());
  if (name.find('/') == std::string::npos && name.find(':') == std::string::npos) return {};
  return Error{ErrorCode::kUnreadable, file.string() + ": names overviews outside its folder"};
}

/// The name under which GDAL opens a file. Of a virtual raster each call gives another one.
///
/// GDAL opens the sources of virtual rasters once for each name and opening thread, and shares them
/// between all handles opened by that thread. Two such handles may serve two threads later, which
/// then read one source at the same time: texels are wrong. Sources are named relative to the
/// virtual raster (check_virtual_raster), so that a folder spelled in a new way keeps them apart.
fs::path name_for_gdal(const fs::path& file) {
  // Absolute, so that GDAL does not interpret it as one of its special names.
  if (!is_virtual_raster(file)) return fs::absolute(file);
  static std::atomic<std::uint64_t> opened{0};
  std::error_code failed;
  const fs::path place = fs::weakly_canonical(fs::absolute(file), failed);
  if (failed) return fs::absolute(file);  // vanished: GDAL reports it
  std::string folder = place.parent_path().string();
  // A binary number whose digits change nothing about the place.
  for (std::uint64_t digits = ++opened; digits > 0; digits /= 2) {
    folder += digits % 2 == 1 ? "//." : "/.";
  }
  return folder + "/" + place.filename().string();
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
  const fs::path name = name_for_gdal(file);
  const CheckedName checked(name);
  DatasetPtr dataset(GDALDataset::Open(
      name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, options.List(), nullptr));
  if (!dataset) {
    std::string reason = messages.text();
    for (const std::string& doubt : SideCars().doubts(file)) reason += "; " + doubt;
    return Error{ErrorCode::kUnreadable, file.string() + ": not a readable raster: " + reason};
  }
  if (dataset->GetRasterCount() < 1) {
    return Error{ErrorCode::kUnreadable, file.string() + ": has no raster band"};
  }
  if (Status status = check_overviews(*dataset, file); !status) return status.error();
  messages.pass_on();
  return dataset;
}

namespace {

/// Number of idle handles in all pools.
std::atomic<int>& idle_handles() {
  static std::atomic<int> count{0};
  return count;
}

}  // namespace

DatasetPool::DatasetPool(fs::path file, int level, DatasetPtr first)
    : file_(std::move(file)), level_(level), identity_(file_identity(file_)) {
  if (first) keep(std::move(first));
}

Result<DatasetPtr> DatasetPool::take() {
  const auto now = file_identity(file_);
  const bool there = now && identity_ && now->same_file(*identity_);
  if (there && !now->same_content(*identity_)) {
    return Error{ErrorCode::kIo, file_.string() + ": was modified while it was in use"};
  }
  std::unique_lock lock(mutex_);
  if (!there && in_use_ > 0) {
    constexpr std::chrono::seconds kPatience{2};
    returned_.wait_for(lock, kPatience, [this] { return !idle_.empty(); });
  }
  if (idle_.empty() && !there) {
    return Error{ErrorCode::kIo,
                 file_.string() + (now ? ": was replaced while it was in use"
                                       : ": was removed after the world was opened")};
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
  // A file that was readable before and is not now is a read error, whatever error GDAL reports.
  return Error{ErrorCode::kIo, opened.error().message};
}

void DatasetPool::put(DatasetPtr dataset) {
  const std::lock_guard lock(mutex_);
  --in_use_;
  keep(std::move(dataset));
  returned_.notify_one();
}

void DatasetPool::keep(DatasetPtr dataset) {
  // A world of a thousand files must not exhaust the process's file descriptors.
  constexpr int kMostIdle = 400;
  if (idle_handles() >= kMostIdle) return;
  ++idle_handles();
  idle_.push_back(std::move(dataset));
}

DatasetPool::~DatasetPool() { idle_handles() -= static_cast<int>(idle_.size()); }

}  // namespace overfly::terrain
