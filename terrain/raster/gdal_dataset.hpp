// Inside terrain only: GDAL datasets with an owner, and the messages of GDAL while one is used.
#pragma once

#include <gdal_priv.h>

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "terrain/files/file_identity.hpp"
#include "terrain/raster/gdal_messages.hpp"

namespace overfly::terrain {

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetPtr = std::unique_ptr<GDALDataset, DatasetCloser>;

/// Registers the drivers of local raster files, disables GDAL's other file systems and limits the
/// block cache; may be called repeatedly.
void initialise_gdal();

/// Opens a raster for reading. Level 0 is the file itself, n > 0 its n-th overview. GDAL's messages
/// without an error are passed to the caller's GdalMessages. The handle shares nothing with others,
/// so that any thread may use it, one at a time.
/// Errors: kNotFound; kUnreadable with GDAL's reason, also for anything but a regular file, and as
/// check_virtual_raster.
[[nodiscard]] Result<DatasetPtr> open_raster(const std::filesystem::path& file, int level = 0);

/// Several handles on one file, because a GDAL handle serves one thread at a time. All refer to the
/// file that the name denoted when the pool was created: if it was removed or replaced since, the
/// open handles continue to work.
class DatasetPool {
 public:
  /// @param first  an open handle, or null
  DatasetPool(std::filesystem::path file, int level, DatasetPtr first = nullptr);
  ~DatasetPool();
  DatasetPool(const DatasetPool&) = delete;
  DatasetPool& operator=(const DatasetPool&) = delete;

  /// A handle for exclusive use; return it with `put`.
  /// Errors: kIo naming the file: it was written to, or it was removed and no handle is returned
  /// within 2 s.
  [[nodiscard]] Result<DatasetPtr> take();
  void put(DatasetPtr dataset);

 private:
  [[nodiscard]] Result<DatasetPtr> open_another();
  /// Closes it instead if there are many.
  void keep(DatasetPtr dataset);

  std::filesystem::path file_;
  int level_;
  std::optional<FileIdentity> identity_;
  std::mutex mutex_;
  std::condition_variable returned_;
  int in_use_ = 0;
  std::vector<DatasetPtr> idle_;
};

}  // namespace overfly::terrain
