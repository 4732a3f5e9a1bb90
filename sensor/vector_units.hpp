// The processor's vector units, for the sensor's loops.
#pragma once

namespace overfly::sensor {

/// The vector units that a sensor may use; they do not affect the image. For tests and benchmarks.
enum class VectorUnits { kBest, kNone, kAvx2, kAvx512 };
/// Whether this machine has them.
[[nodiscard]] bool supported(VectorUnits units);

}  // namespace overfly::sensor
