#include "terrain/files/file_digest.hpp"

#include <cstdint>
#include <fstream>
#include <vector>

#include "core/measure/sha256.hpp"
#include "core/outside/file_text.hpp"

namespace overfly::terrain {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
constexpr std::uint64_t kWholeBytes = 32 * kMiB;
constexpr int kSamples = 32;
constexpr std::string_view kSampled = "sha256-sampled:";

}  // namespace

Result<std::string> file_digest(const std::filesystem::path& file) {
  if (Status status = check_regular_file(file); !status) return status.error();
  std::ifstream in(file, std::ios::binary);
  std::error_code failed;
  const std::uint64_t size = std::filesystem::file_size(file, failed);
  if (!in || failed) return Error{ErrorCode::kIo, file.string() + ": cannot be read"};
  const bool whole = size <= kWholeBytes;
  Sha256 hash;
  std::vector<std::uint8_t> buffer(kMiB);
  if (!whole) {
    const std::string text = std::to_string(size);
    hash.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  const std::uint64_t pieces = whole ? (size + kMiB - 1) / kMiB : kSamples;
  for (std::uint64_t piece = 0; piece < pieces; ++piece) {
    const std::uint64_t at = whole ? piece * kMiB : (size - kMiB) * piece / (kSamples - 1);
    in.seekg(static_cast<std::streamoff>(at));
    in.read(reinterpret_cast<char*>(buffer.data()), static_cast<std::streamsize>(kMiB));
    if (in.bad()) return Error{ErrorCode::kIo, file.string() + ": reading failed"};
    hash.add({buffer.data(), static_cast<std::size_t>(in.gcount())});
    in.clear();
  }
  return (whole ? "sha256:" : std::string(kSampled)) + hex_text(hash.finish());
}

bool digest_is_sampled(std::string_view digest) { return digest.starts_with(kSampled); }

}  // namespace overfly::terrain
