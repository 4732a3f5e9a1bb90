// Frames of a recording or made by hand, sent over a socket as a vehicle would.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

#include "flight/mavlink/frame_finder.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"

namespace overfly::flight::testing {

/// Calls `take` with each frame of a .tlog and its bytes, until it returns false.
inline void for_each_frame(
    const std::filesystem::path& tlog,
    const std::function<bool(const mavlink::Frame&, std::span<const std::uint8_t>)>& take) {
  std::ifstream file(tlog, std::ios::binary);
  std::vector<std::uint8_t> bytes;
  std::vector<char> piece(1 << 20);
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    bytes.insert(bytes.end(), piece.begin(), piece.begin() + file.gcount());
  }
  mavlink::FrameFinder finder(8);
  std::span<const std::uint8_t> rest = bytes;
  while (true) {
    const mavlink::FrameFinder::Found found = finder.next(rest, true);
    if (!found.frame || !take(*found.frame, found.bytes)) return;
    rest = rest.subspan(found.consumed_bytes);
  }
}

}  // namespace overfly::flight::testing
