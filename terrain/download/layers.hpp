// Inside download only: the layers of a download, cut into requests.
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

/// The imagery and elevation that the options ask for; an elevation layer only where it has a
/// source. Errors: kInvalidArgument naming the option; kIo, kCancelled.
[[nodiscard]] Result<std::vector<ChunkLayer>> lay_out_download(const DownloadOptions& options,
                                                               PoliteFetcher& fetcher,
                                                               std::vector<std::string>& warnings);

/// Layers of The National Map's image services. NAD83 UTM where it has zones there, which is what
/// the imagery was made in, else WGS84 UTM.
[[nodiscard]] Result<ChunkLayer> usgs_layer(const DownloadOptions& options,
                                            bool heights,
                                            PoliteFetcher& fetcher,
                                            std::vector<std::string>& warnings);

/// Layer of a template of tile or WMS addresses, Web Mercator.
[[nodiscard]] Result<ChunkLayer> template_layer(const DownloadOptions& options);

/// Replaces "{name}" wherever it stands; false if it stands nowhere.
bool replace_field(std::string& text, const std::string& name, const std::string& value);

/// Metres or other units with as many digits as bits can hold, no exponent.
[[nodiscard]] std::string plain_number(double value);

}  // namespace overfly::terrain::download
