#include "sensor/sensor.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/time.hpp"
#include "sensor/defocus.hpp"
#include "sensor/exposure_control.hpp"
#include "sensor/noise_source.hpp"
#include "sensor/pixel_chain.hpp"

namespace overfly::sensor {

namespace {

double half_diagonal_px(const PinholeCamera& pinhole) {
  return 0.5 * std::hypot(pinhole.width_px, pinhole.height_px);
}

/// The vignette's transmission must be in (0, 1] at every pixel.
Status check_vignette(const Vignette& vignette, const PinholeCamera& pinhole) {
  const double far_x = std::max(pinhole.cx_px, pinhole.width_px - 1 - pinhole.cx_px);
  const double far_y = std::max(pinhole.cy_px, pinhole.height_px - 1 - pinhole.cy_px);
  const double corner = std::hypot(far_x, far_y) / half_diagonal_px(pinhole);
  constexpr int kSteps = 1000;
  for (int i = 0; i <= kSteps; ++i) {
    const double r = corner * i / kSteps;
    const double transmission = vignette.transmission(r);
    if (transmission > 0.0 && transmission <= 1.0 + 1e-9) continue;
    return Error{ErrorCode::kInvalidArgument,
                 "vignette: transmission " + std::to_string(transmission) + " at radius " +
                     std::to_string(r) + " of half the diagonal: must be in (0, 1]"};
  }
  return {};
}

/// A field of standard normals that belongs to the sensor, one value per sample.
std::vector<float> pattern(std::uint64_t seed, NoiseStage stage, std::size_t samples) {
  const NoiseKey key = noise_key(seed, 0, stage);
  std::vector<float> values(samples);
  ChunkWords words;
  for (std::size_t start = 0; start < samples; start += kChunk) {
    draw_words(key, static_cast<std::uint32_t>(start / 4), words);
    const std::size_t count = std::min<std::size_t>(kChunk, samples - start);
    for (std::size_t i = 0; i < count; ++i) values[start + i] = normal_pair(words.of[i]).first;
  }
  return values;
}

/// The response as a table over the converter's numbers.
std::vector<std::uint16_t> response_table(const SensorModel& model) {
  const int largest_in = (1 << model.effective_adc_bits()) - 1;
  const int largest_out = (1 << model.bits) - 1;
  std::vector<std::uint16_t> table;
  for (int number = 0; number <= largest_in; ++number) {
    const double output = model.response(static_cast<double>(number) / largest_in);
    table.push_back(static_cast<std::uint16_t>(std::lround(output * largest_out)));
  }
  return table;
}

class ModelledSensor final : public Sensor {
 public:
  ModelledSensor(const SensorModel& model,
                 const PinholeCamera& pinhole,
                 std::uint64_t seed,
                 VectorUnits units)
      : model_(model),
        pinhole_(pinhole),
        seed_(seed),
        expose_row_(expose_row_for(units)),
        control_(model) {
    const int adc_bits = model.effective_adc_bits();
    if (!model.response.is_linear() || adc_bits != model.bits) table_ = response_table(model);
    if (model.bits == 8) table_8bit_.assign(table_.begin(), table_.end());
    largest_adc_ = (1 << adc_bits) - 1;
    adc_per_dn_ = static_cast<double>(largest_adc_) / ((1 << model.bits) - 1);
  }

  [[nodiscard]] ExposureSetting next_setting() const override { return control_.setting(); }

  [[nodiscard]] SensorImage expose(const RadianceImage& radiance, std::int64_t frame) override {
    assert(radiance.width_px == pinhole_.width_px && radiance.height_px == pinhole_.height_px);
    prepare(radiance.channels);
    SensorImage made;
    made.setting = control_.setting();
    made.image = Image(radiance.width_px, radiance.height_px, radiance.channels);
    if (model_.bits > 8) {
      made.image16 = Image16(radiance.width_px, radiance.height_px, radiance.channels);
    }
    if (model_.defocus_sigma_px > 0.0) {
      expose_rows(defocused(radiance, model_.defocus_sigma_px), frame, made);
    } else {
      expose_rows(radiance, frame, made);
    }
    const double black = model_.black_level_dn * adc_per_dn_ / largest_adc_;
    control_.observe((made.mean_level - black) / (1.0 - black), made.saturated_fraction);
    return made;
  }

 private:
  /// Prepares the data that depends on the number of channels; grey and colour may alternate.
  void prepare(int channels) {
    if (channels == channels_) return;
    channels_ = channels;
    const int samples = pinhole_.width_px * channels;
    const double scale = 1.0 / half_diagonal_px(pinhole_);
    x_term_.clear();
    for (int i = 0; i < samples; ++i) {
      const int x = i / channels;
      const double dx = (x - pinhole_.cx_px) * scale;
      x_term_.push_back(static_cast<float>(dx * dx));
    }
    numbers_.resize(static_cast<std::size_t>(counters_per_row(samples)) * 4);
    const std::size_t all = static_cast<std::size_t>(samples) * pinhole_.height_px;
    gain_pattern_.clear();
    offset_pattern_e_.clear();
    if (model_.prnu > 0.0) {
      gain_pattern_ = pattern(seed_, NoiseStage::kGainPattern, all);
      const auto prnu = static_cast<float>(model_.prnu);
      for (float& value : gain_pattern_) value = 1.0F + prnu * value;
    }
    if (model_.dsnu_e > 0.0) {
      offset_pattern_e_ = pattern(seed_, NoiseStage::kOffsetPattern, all);
      for (float& value : offset_pattern_e_) value *= static_cast<float>(model_.dsnu_e);
    }
  }

  [[nodiscard]] PixelChain chain_of(const ExposureSetting& setting, std::int64_t frame) const {
    PixelChain chain;
    chain.electrons_per_radiance =
        static_cast<float>(model_.electrons_per_s * s_from_ns(setting.exposure_ns));
    for (std::size_t i = 0; model_.vignette && i < 3; ++i) {
      chain.vignette[i] = static_cast<float>(model_.vignette->a[i]);
    }
    chain.shot_noise = model_.shot_noise;
    if (model_.full_well_e > 0.0) chain.full_well_e = static_cast<float>(model_.full_well_e);
    chain.read_noise_e = static_cast<float>(model_.read_noise_e);
    chain.dn_per_e =
        static_cast<float>(model_.effective_gain_dn_per_e() * setting.gain * adc_per_dn_);
    chain.black_dn = static_cast<float>(model_.black_level_dn * adc_per_dn_);
    chain.largest_dn = largest_adc_;
    chain.temporal = noise_key(seed_, frame, NoiseStage::kTemporal);
    chain.few_electrons = noise_key(seed_, frame, NoiseStage::kFewElectrons);
    return chain;
  }

  void expose_rows(const RadianceImage& radiance, std::int64_t frame, SensorImage& made) {
    const PixelChain chain = chain_of(made.setting, frame);
    const int samples = radiance.width_px * radiance.channels;
    const double scale = 1.0 / half_diagonal_px(pinhole_);
    RowResult result;
    result.numbers = numbers_.data();
    for (int y = 0; y < radiance.height_px; ++y) {
      const std::size_t start = static_cast<std::size_t>(y) * samples;
      const double dy = (y - pinhole_.cy_px) * scale;
      SensorRow row;
      row.radiance = &radiance.data[start];
      row.samples = samples;
      row.readable = static_cast<int>(radiance.data.size() - start);
      row.x_term = x_term_.data();
      row.y_term = static_cast<float>(dy * dy);
      if (!gain_pattern_.empty()) row.gain_pattern = &gain_pattern_[start];
      if (!offset_pattern_e_.empty()) row.offset_pattern_e = &offset_pattern_e_[start];
      row.counter = static_cast<std::uint32_t>(y) * counters_per_row(samples);
      expose_row_(chain, row, result);
      respond(samples, start, made);
    }
    const auto count = static_cast<double>(radiance.data.size());
    made.mean_level = static_cast<double>(result.sum) / (count * largest_adc_);
    made.saturated_fraction = static_cast<double>(result.saturated) / count;
  }

  /// Converts a row of the converter's numbers to the file's.
  void respond(int samples, std::size_t start, SensorImage& made) {
    std::uint8_t* eight_bits = &made.image.data[start];
    if (model_.bits == 8) {
      respond_8bit(numbers_.data(), samples, eight_bits);
      return;
    }
    std::uint16_t* deep = &made.image16.data[start];
    for (int i = 0; i < samples; ++i) deep[i] = table_.empty() ? numbers_[i] : table_[numbers_[i]];
    const int shift = model_.bits - 8;
    for (int i = 0; i < samples; ++i) eight_bits[i] = static_cast<std::uint8_t>(deep[i] >> shift);
  }

  /// The pointers do not overlap. Without __restrict, writing bytes could alias any other data.
  void respond_8bit(const std::uint16_t* __restrict numbers,
                    int samples,
                    std::uint8_t* __restrict out) const {
    if (table_.empty()) {
      for (int i = 0; i < samples; ++i) out[i] = static_cast<std::uint8_t>(numbers[i]);
    } else {
      const std::uint8_t* __restrict table = table_8bit_.data();
#pragma GCC unroll 8
      for (int i = 0; i < samples; ++i) out[i] = table[numbers[i]];
    }
  }

  SensorModel model_;
  PinholeCamera pinhole_;
  std::uint64_t seed_;
  ExposeRow expose_row_;
  ExposureControl control_;
  std::vector<std::uint16_t> table_;      ///< empty = the converter's numbers are the file's
  std::vector<std::uint8_t> table_8bit_;  ///< the same for 8-bit images
  int largest_adc_ = 255;
  double adc_per_dn_ = 1.0;  ///< converter's numbers per number of depth `bits`
  int channels_ = 0;         ///< for which the following are prepared
  std::vector<float> x_term_;
  std::vector<float> gain_pattern_;
  std::vector<float> offset_pattern_e_;
  std::vector<std::uint16_t> numbers_;  ///< of one row, whole chunks
};

}  // namespace

Result<std::unique_ptr<Sensor>> Sensor::create(const SensorModel& model,
                                               const CameraModel& camera,
                                               std::uint64_t seed,
                                               VectorUnits units) {
  if (Status status = model.validate(); !status) return status.error().in("sensor");
  if (Status status = camera.validate(); !status) return status.error().in("camera");
  if (model.vignette) {
    if (Status status = check_vignette(*model.vignette, camera.pinhole()); !status) {
      return status.error().in("sensor");
    }
  }
  return std::unique_ptr<Sensor>(
      std::make_unique<ModelledSensor>(model, camera.pinhole(), seed, units));
}

}  // namespace overfly::sensor
