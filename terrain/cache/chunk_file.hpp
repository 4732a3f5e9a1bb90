// Inside terrain only: a file of a few dozen independent pieces, written whole or not at all.
//
// Layout, little-endian: "OVFCHNK1", uint32 count, then per piece uint64 offset, uint32 size,
// uint32 check (Adler-32 of the piece, RFC 1950); then the pieces. Size 0 = there is none.
#pragma once

#include <filesystem>

#include "core/result.hpp"
#include "terrain/cache/block_codec.hpp"

namespace overfly::terrain {

/// Writes to a temporary name and renames the file, so that a reader, a second writer or a killed
/// program never leaves a partial file. Errors: kIo.
[[nodiscard]] Status write_chunk(const std::filesystem::path& file,
                                 const std::vector<Bytes>& pieces);

/// One piece; empty if there is none. Errors: kIo naming the file if it is missing, truncated or
/// damaged.
[[nodiscard]] Result<Bytes> read_piece(const std::filesystem::path& file, int index);

/// Reads all of it. Errors: kIo as `read_piece`.
[[nodiscard]] Status check_chunk(const std::filesystem::path& file);

/// Writes a file whole or not at all. Errors: kIo.
[[nodiscard]] Status write_whole(const std::filesystem::path& file,
                                 std::span<const std::uint8_t> bytes);

}  // namespace overfly::terrain
