#include "sensor/defocus.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace overfly::sensor {

namespace {

std::vector<float> gaussian_weights(double sigma_px) {
  const int radius = static_cast<int>(std::ceil(4.0 * sigma_px));
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
    sum += weights.back();
  }
  std::vector<float> scaled(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) scaled[i] = static_cast<float>(weights[i] / sum);
  return scaled;
}

/// Adds weight * in to out, sample by sample.
void add_scaled(const float* in, float weight, std::size_t count, float* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] += weight * in[i];
}

}  // namespace

RadianceImage defocused(const RadianceImage& sharp, double sigma_px) {
  const std::vector<float> weights = gaussian_weights(sigma_px);
  const int radius = static_cast<int>(weights.size() / 2);
  const int channels = sharp.channels;
  const std::size_t row = static_cast<std::size_t>(sharp.width_px) * channels;
  const std::size_t margin = static_cast<std::size_t>(radius) * channels;
  RadianceImage out(sharp.width_px, sharp.height_px, channels);
  std::vector<float> column_sums(row + 2 * margin);
  for (int y = 0; y < sharp.height_px; ++y) {
    std::fill(column_sums.begin(), column_sums.end(), 0.0F);
    for (int k = -radius; k <= radius; ++k) {
      const int from = std::clamp(y + k, 0, sharp.height_px - 1);
      add_scaled(&sharp.data[from * row], weights[k + radius], row, &column_sums[margin]);
    }
    for (std::size_t i = 0; i < margin; ++i) {
      const std::size_t channel = i % channels;
      column_sums[i] = column_sums[margin + channel];
      column_sums[margin + row + i] = column_sums[margin + row - channels + channel];
    }
    for (std::size_t k = 0; k < weights.size(); ++k) {
      add_scaled(&column_sums[k * channels], weights[k], row, &out.data[y * row]);
    }
  }
  return out;
}

}  // namespace overfly::sensor
