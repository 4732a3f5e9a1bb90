// Inside terrain only: GDAL datasets with an owner, and the messages of GDAL while one is used.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "terrain/file_identity.hpp"

namespace overfly::terrain {

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetPtr = std::unique_ptr<GDALDataset, DatasetCloser>;

/// Registers the drivers of local raster files, disables GDAL's other file systems and limits the
/// block cache; may be called repeatedly.
void initialise_gdal();

/// Collects the messages of GDAL and PROJ on this thread instead of printing them. If several
/// objects exist, the newest receives them.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  [[nodiscard]] bool empty() const { return text_.empty(); }
  /// The messages, joined by "; "; "no reason given" if there are none.
  [[nodiscard]] std::string text() const;
  /// Passes the messages on to the object created before this one, if there is one.
  void pass_on() const;

 private:
  static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum number, const char* message);
  void add(std::string line);

  GdalMessages* outer_;
  std::string text_;
};

/// A warning with GDAL's messages about a file that was opened nevertheless.
[[nodiscard]] std::string heard_while_opening(const std::filesystem::path& file,
                                              const GdalMessages& messages);

/// Opens a raster for reading. Level 0 is the file itself, n > 0 its n-th overview. GDAL's messages
/// without an error are passed to the caller's GdalMessages.
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

  std::filesystem::path file_;
  int level_;
  std::optional<FileIdentity> identity_;
  std::mutex mutex_;
  std::condition_variable returned_;
  int in_use_ = 0;
  std::vector<DatasetPtr> idle_;
};

/// The six numbers of an affine georeference, pixel corners at integers:
/// X = g0 + g1 px + g2 py, Y = g3 + g4 px + g5 py.
struct GeoTransform {
  double g[6] = {0, 1, 0, 0, 0, 1};

  [[nodiscard]] bool north_up() const {
    return g[2] == 0.0 && g[4] == 0.0 && g[1] > 0.0 && g[5] < 0.0;
  }
  void crs_from_pixel(double px, double py, double& x, double& y) const;
  void pixel_from_crs(double x, double y, double& px, double& py) const;
};

/// Checked georeference of a raster.
struct Georeference {
  GeoTransform transform;
  OGRSpatialReference crs;  ///< traditional axis order: x = east or longitude
};

/// Reads the georeference; `crs_override` ("EPSG:2994", see check_crs_text) is used if the file has
/// none.
/// @param said  GDAL's messages from opening the file
/// Errors: kInvalidArgument naming the file: no CRS, no or degenerate transform, a place outside
/// the CRS's range.
[[nodiscard]] Result<Georeference> read_georeference(GDALDataset& dataset,
                                                     const std::filesystem::path& file,
                                                     const std::optional<std::string>& crs_override,
                                                     const std::string& said);

}  // namespace overfly::terrain
