// Samples of sensors in rows of CSV files. Private to csv.
#pragma once

#include <array>
#include <cstdint>

#include "core/sensors/sensor_samples.hpp"
#include "flight/logs/csv/csv_mapping.hpp"

namespace overfly::flight::logs {

/// The samples in a row: at most one of each sensor, fewer if a value cannot be right. Positions
/// are those of a GPS if that is the piece's origin, with heights above mean sea level and without
/// velocity and accuracies. The temperature of the air is not known.
/// @param values  by CsvQuantity, in the units of CsvColumn
[[nodiscard]] SensorSamples csv_samples_of(const CsvPiece& piece,
                                           const std::array<double, kCsvQuantities>& values,
                                           std::int64_t t_ns);

}  // namespace overfly::flight::logs
