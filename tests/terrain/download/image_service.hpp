// Answers as the image services and tile servers of the web do, with made-up land.
#pragma once

#include <string>

#include "tests/terrain/local_http_server.hpp"

namespace overfly::testing {

/// The description of an ArcGIS image service with this largest image.
[[nodiscard]] HttpAnswer image_service_description(int most_px);

/// What exportImage answers: a GeoTIFF of bbox, size and imageSR. The pixel at CRS coordinates
/// (x, y) has red = floor(x / 5) mod 256, green = floor(y / 5) mod 256, blue = 77; heights are
/// `service_height_m(x, y)`.
[[nodiscard]] HttpAnswer export_image(const HttpRequest& request);
[[nodiscard]] double service_height_m(double x, double y);

/// A PNG tile whose pixels all are (z, x mod 256, y mod 256), as large as asked.
[[nodiscard]] HttpAnswer picture_tile(int zoom, int x, int y, int side_px = 256);

}  // namespace overfly::testing
