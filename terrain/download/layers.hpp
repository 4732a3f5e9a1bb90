// Inside download only: the layers of a download, divided into requests.
#pragma once

#include <string>
#include <vector>

#include "terrain/download/chunk.hpp"

namespace overfly::terrain::download {

/// Limits of an ArcGIS image service, from its own description.
struct ImageServiceLimits {
  int width_px = 4000;
  int height_px = 4000;
  std::string credit;
};

/// Asks `SERVICE?f=json`. Errors: kIo, naming the address.
[[nodiscard]] Result<ImageServiceLimits> ask_image_service(const std::string& service,
                                                           PoliteFetcher& fetcher);

/// The imagery and elevation for the options; an elevation layer only if it has a source.
/// Errors: kInvalidArgument naming the option; kIo, kCancelled.
[[nodiscard]] Result<std::vector<ChunkLayer>> lay_out_download(const DownloadOptions& options,
                                                               PoliteFetcher& fetcher,
                                                               std::vector<std::string>& warnings);

/// Layers of The National Map's image services. NAD83 UTM where its zones exist, which is the CRS
/// of the original imagery; else WGS84 UTM.
[[nodiscard]] Result<ChunkLayer> usgs_layer(const DownloadOptions& options,
                                            bool heights,
                                            PoliteFetcher& fetcher,
                                            std::vector<std::string>& warnings);

/// Layer of a template of tile or WMS addresses, Web Mercator.
[[nodiscard]] Result<ChunkLayer> template_layer(const DownloadOptions& options);

/// Replaces all occurrences of "{name}"; false if there are none.
bool replace_field(std::string& text, const std::string& name, const std::string& value);

/// Decimal text of full double precision, without exponent.
[[nodiscard]] std::string plain_number(double value);

}  // namespace overfly::terrain::download
