#include "terrain/raster/file_soundness.hpp"

#include <cpl_minixml.h>

#include <algorithm>
#include <memory>

#include "terrain/files/side_cars.hpp"
#include "terrain/raster/block_search.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

/// Errors: kUnreadable if a block of the band reaches beyond the end of the file.
Status check_blocks(GDALRasterBand& band,
                    const fs::path& file,
                    std::uintmax_t file_bytes,
                    const Cancelled& cancelled) {
  const auto is_beyond_the_end = [&](int x, int y) -> Result<bool> {
    const std::string at = std::to_string(x) + "_" + std::to_string(y);
    const char* offset = band.GetMetadataItem(("BLOCK_OFFSET_" + at).c_str(), "TIFF");
    const char* size = band.GetMetadataItem(("BLOCK_SIZE_" + at).c_str(), "TIFF");
    if (offset == nullptr || size == nullptr) return false;
    const unsigned long long end = std::stoull(offset) + std::stoull(size);
    if (end <= file_bytes) return false;
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": is truncated: block " + at + " ends at byte " +
                     std::to_string(end) + ", the file has " + std::to_string(file_bytes)};
  };
  const Result<bool> searched = any_block(band, file, cancelled, is_beyond_the_end);
  return searched ? Status{} : Status{searched.error()};
}

Status check_tiff(GDALDataset& dataset, const fs::path& file, const Cancelled& cancelled) {
  std::error_code failed;
  const auto file_bytes = fs::file_size(file, failed);
  if (failed) return {};
  Status whole = check_blocks(*dataset.GetRasterBand(1), file, file_bytes, cancelled);
  const int last = dataset.GetRasterCount();
  // Bands may be stored one after the other.
  if (whole && last > 1) {
    whole = check_blocks(*dataset.GetRasterBand(last), file, file_bytes, cancelled);
  }
  return whole;
}

/// Files that the description of a virtual raster names, in its order.
void add_sources(const CPLXMLNode* node, const fs::path& folder, std::vector<fs::path>& sources) {
  for (; node != nullptr; node = node->psNext) {
    if (node->eType != CXT_Element) continue;
    if (std::string(node->pszValue) == "SourceFilename") {
      fs::path source = CPLGetXMLValue(node, nullptr, "");
      const bool relative = std::string(CPLGetXMLValue(node, "relativeToVRT", "0")) == "1";
      if (relative) source = folder / source;
      if (std::find(sources.begin(), sources.end(), source) == sources.end()) {
        sources.push_back(std::move(source));
      }
    } else {
      add_sources(node->psChild, folder, sources);
    }
  }
}

Status check_sources(GDALDataset& dataset,
                     const fs::path& file,
                     const Cancelled& cancelled,
                     std::vector<std::string>& warnings) {
  char** description = dataset.GetMetadata("xml:VRT");
  if (description == nullptr || description[0] == nullptr) return {};
  const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> xml(
      CPLParseXMLString(description[0]), &CPLDestroyXMLNode);
  std::vector<fs::path> sources;
  add_sources(xml.get(), file.parent_path(), sources);
  SideCars side_cars;
  for (const fs::path& source : sources) {
    if (Status status = go_on(cancelled, file); !status) return status;
    auto opened = open_raster(source);
    if (!opened) return opened.error().in(file.string() + ": is made of");
    const Status whole = check_whole(**opened, source, cancelled, warnings);
    if (!whole) return whole.error().in(file.string() + ": is made of");
    const std::vector<std::string> doubts = side_cars.doubts(source);
    warnings.insert(warnings.end(), doubts.begin(), doubts.end());
  }
  return {};
}

/// Formats that are read sequentially fail at the truncated part before they reach the end.
Status check_last_row(GDALDataset& dataset,
                      const fs::path& file,
                      const Cancelled& cancelled,
                      std::vector<std::string>& warnings) {
  const GdalMessages messages;
  GDALRasterBand* band = dataset.GetRasterBand(dataset.GetRasterCount());
  const int width = band->GetXSize();
  std::vector<float> row(static_cast<std::size_t>(width));
  std::vector<int> rows = rows_on_the_way(*band);
  rows.push_back(band->GetYSize() - 1);
  CPLErr outcome = CE_None;
  for (std::size_t i = 0; i < rows.size() && outcome == CE_None; ++i) {
    if (Status status = go_on(cancelled, file); !status) return status;
    outcome = band->RasterIO(
        GF_Read, 0, rows[i], width, 1, row.data(), width, 1, GDT_Float32, 0, 0, nullptr);
  }
  if (outcome != CE_None) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": its last row cannot be read: " + messages.text()};
  }
  if (!messages.empty()) {
    warnings.push_back(file.string() + ": may be damaged; GDAL reported on reading its last row: " +
                       messages.text());
  }
  return {};
}

}  // namespace

std::vector<int> rows_on_the_way(GDALRasterBand& band) {
  int block_width = 0;
  int block_height = 0;
  band.GetBlockSize(&block_width, &block_height);
  std::vector<int> rows;
  if (block_height > 1 || block_width < band.GetXSize()) return rows;
  constexpr int kStretches = 256;
  for (int i = 1; i < kStretches; ++i) {
    const auto row = static_cast<int>(static_cast<std::int64_t>(band.GetYSize()) * i / kStretches);
    if (row > (rows.empty() ? 0 : rows.back())) rows.push_back(row);
  }
  return rows;
}

Status check_whole(GDALDataset& dataset,
                   const fs::path& file,
                   const Cancelled& cancelled,
                   std::vector<std::string>& warnings) {
  const std::string format = dataset.GetDriver()->GetDescription();
  if (format == "GTiff") return check_tiff(dataset, file, cancelled);
  if (format == "VRT") return check_sources(dataset, file, cancelled, warnings);
  return check_last_row(dataset, file, cancelled, warnings);
}

}  // namespace overfly::terrain
