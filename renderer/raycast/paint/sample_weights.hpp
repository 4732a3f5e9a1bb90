// Constants shared by all sampling kernels.
#pragma once

namespace overfly::renderer::raycast {

/// Weights of the two rows and the two columns of a bilinear sample of 8-bit texels, as integers:
/// the rows' fit a signed byte, and 255 times both fits 32 bits.
inline constexpr int kRowOne = 127;
inline constexpr int kColumnOne = 16384;
inline constexpr float kPerProduct = 1.0F / (127.0F * 16384.0F);

}  // namespace overfly::renderer::raycast
