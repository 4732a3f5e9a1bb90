#include "sensor/image_faults.hpp"

#include <algorithm>
#include <cmath>

#include "sensor/defocus.hpp"
#include "sensor/noise_source.hpp"
#include "sensor/number_limit.hpp"

namespace overfly::sensor {

namespace {

/// A position in the image [px], between pixels.
struct Place {
  double x = 0.0;
  double y = 0.0;
};

/// A range of pixels [first, last) within the image.
struct Box {
  int x0, y0, x1, y1;
};

Place draw_place(SeededSequence& random, const RadianceImage& image) {
  const double x = random.next() * image.width_px - 0.5;
  return {x, random.next() * image.height_px - 0.5};
}

Box box_around(const Place& centre, double radius_px, const RadianceImage& image) {
  const auto clamped = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  return {clamped(std::floor(centre.x - radius_px), image.width_px),
          clamped(std::floor(centre.y - radius_px), image.height_px),
          clamped(std::ceil(centre.x + radius_px) + 1.0, image.width_px),
          clamped(std::ceil(centre.y + radius_px) + 1.0, image.height_px)};
}

/// 0 up to `low`, 1 from `high` on, in between a cubic with zero slope at both ends.
double smooth_step(double low, double high, double value) {
  const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

void scale_all(RadianceImage& image, float factor) {
  for (float& value : image.data) value *= factor;
}

void add_glare(const ImageFault& fault, RadianceImage& image) {
  if (fault.radius_px <= 0.0) {
    for (float& value : image.data) value += static_cast<float>(fault.strength);
    return;
  }
  SeededSequence random(fault.seed);
  const Place centre = draw_place(random, image);
  // The Gaussian is separable: one factor for each column, one for each row.
  const auto factor = [&](double distance_px) {
    return std::exp(-0.5 * distance_px * distance_px / (fault.radius_px * fault.radius_px));
  };
  std::vector<float> columns(static_cast<std::size_t>(image.width_px));
  for (int x = 0; x < image.width_px; ++x) columns[x] = static_cast<float>(factor(x - centre.x));
  for (int y = 0; y < image.height_px; ++y) {
    const auto middle = static_cast<float>(fault.strength * factor(y - centre.y));
    for (int x = 0; x < image.width_px; ++x) {
      for (int c = 0; c < image.channels; ++c) image.at(x, y, c) += middle * columns[x];
    }
  }
}

/// A speck near the lens is far out of focus: a disc with a wide soft rim.
void add_speck(const Place& centre, double radius_px, double opacity, RadianceImage& image) {
  const Box box = box_around(centre, radius_px, image);
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const double r = std::hypot(x - centre.x, y - centre.y) / radius_px;
      const auto passed = static_cast<float>(1.0 - opacity * (1.0 - smooth_step(0.3, 1.0, r)));
      for (int c = 0; c < image.channels; ++c) image.at(x, y, c) *= passed;
    }
  }
}

/// Bilinear interpolation of the radiance; beyond the edge the edge's pixel is repeated.
float sampled(const RadianceImage& image, double x, double y, int channel) {
  const double inside_x = std::clamp(x, 0.0, image.width_px - 1.0);
  const double inside_y = std::clamp(y, 0.0, image.height_px - 1.0);
  const int x0 = static_cast<int>(inside_x);
  const int y0 = static_cast<int>(inside_y);
  const int x1 = std::min(x0 + 1, image.width_px - 1);
  const int y1 = std::min(y0 + 1, image.height_px - 1);
  const auto u = static_cast<float>(inside_x - x0);
  const auto v = static_cast<float>(inside_y - y0);
  const float above = image.at(x0, y0, channel) * (1 - u) + image.at(x1, y0, channel) * u;
  const float below = image.at(x0, y1, channel) * (1 - u) + image.at(x1, y1, channel) * u;
  return above * (1 - v) + below * v;
}

/// A drop is a strong lens: it shows a field three times its own size, rotated by 180 deg.
constexpr double kDropDemagnification = 3.0;
constexpr double kLargestDropBlurPx = 12.0;

void add_drop(const Place& centre, double radius_px, double opacity, RadianceImage& image) {
  const Box box = box_around(centre, radius_px, image);
  if (box.x0 >= box.x1 || box.y0 >= box.y1) return;
  RadianceImage inside(box.x1 - box.x0, box.y1 - box.y0, image.channels);
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const double from_x = centre.x - kDropDemagnification * (x - centre.x);
      const double from_y = centre.y - kDropDemagnification * (y - centre.y);
      for (int c = 0; c < image.channels; ++c) {
        inside.at(x - box.x0, y - box.y0, c) = sampled(image, from_x, from_y, c);
      }
    }
  }
  const double sigma_px = std::min(0.1 * radius_px, kLargestDropBlurPx);
  inside = defocused(inside, std::max(sigma_px, 0.5));
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const double r = std::hypot(x - centre.x, y - centre.y) / radius_px;
      const auto cover = static_cast<float>(opacity * (1.0 - smooth_step(0.8, 1.0, r)));
      // Near the rim most light is refracted away from the camera.
      const auto light = static_cast<float>(1.0 - 0.6 * smooth_step(0.55, 0.95, r));
      for (int c = 0; c < image.channels; ++c) {
        float& value = image.at(x, y, c);
        value += cover * (light * inside.at(x - box.x0, y - box.y0, c) - value);
      }
    }
  }
}

/// Adds specks or drops, each with its own position and size.
void add_spots(const ImageFault& fault, RadianceImage& image) {
  SeededSequence random(fault.seed);
  const bool dirt = fault.kind == ImageFaultKind::kDirt;
  const int count = fault.count > 0 ? fault.count : (dirt ? 20 : 1);
  for (int i = 0; i < count; ++i) {
    const Place centre = draw_place(random, image);
    const double size = random.next();
    const double opacity = fault.strength * (0.5 + 0.5 * random.next());
    if (dirt) {
      add_speck(centre, fault.radius_px * (0.5 + size), opacity, image);
    } else {
      // The first drop has the requested size.
      const double share = i == 0 ? 1.0 : 0.3 + 0.7 * size;
      add_drop(centre, fault.radius_px * share, fault.strength, image);
    }
  }
}

}  // namespace

const char* to_string(ImageFaultKind kind) {
  switch (kind) {
    case ImageFaultKind::kSaturation:
      return "saturation";
    case ImageFaultKind::kDirt:
      return "dirt";
    case ImageFaultKind::kWaterDrop:
      return "water_drop";
    case ImageFaultKind::kBlackout:
      return "blackout";
  }
  return "";
}

std::optional<ImageFaultKind> image_fault_kind_from(const std::string& text) {
  for (const auto kind : {ImageFaultKind::kSaturation,
                          ImageFaultKind::kDirt,
                          ImageFaultKind::kWaterDrop,
                          ImageFaultKind::kBlackout}) {
    if (text == to_string(kind)) return kind;
  }
  return std::nullopt;
}

Status ImageFault::validate() const {
  const bool light = kind == ImageFaultKind::kSaturation;
  const bool spots = kind == ImageFaultKind::kDirt || kind == ImageFaultKind::kWaterDrop;
  const double most_px = kind == ImageFaultKind::kWaterDrop ? 1000.0 : 10000.0;
  return check_limits({
      {"strength", strength, 1e-6, light ? 1000.0 : 1.0},
      {"radius_px", radius_px, spots ? 1.0 : 0.0, most_px},
      {"count", static_cast<double>(count), 0, 1000},
  });
}

void apply_fault(const ImageFault& fault, RadianceImage& radiance) {
  switch (fault.kind) {
    case ImageFaultKind::kSaturation:
      return add_glare(fault, radiance);
    case ImageFaultKind::kDirt:
    case ImageFaultKind::kWaterDrop:
      return add_spots(fault, radiance);
    case ImageFaultKind::kBlackout:
      return scale_all(radiance, static_cast<float>(1.0 - fault.strength));
  }
}

}  // namespace overfly::sensor
