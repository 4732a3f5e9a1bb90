#include "terrain/cache/chunk_file.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

constexpr char kMagic[] = "OVFCHNK1";
constexpr std::size_t kMagicBytes = 8;
constexpr std::size_t kHeadBytes = kMagicBytes + 4;
constexpr std::size_t kRowBytes = 16;

std::uint32_t adler32(std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t kModulus = 65521;
  constexpr std::size_t kRun = 5552;  // maximum run for which the sums stay below 2^32
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (std::size_t at = 0; at < bytes.size(); at += kRun) {
    for (const std::uint8_t byte : bytes.subspan(at, std::min(kRun, bytes.size() - at))) {
      a += byte;
      b += a;
    }
    a %= kModulus;
    b %= kModulus;
  }
  return b << 16U | a;
}

void put(Bytes& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint64_t get(const std::uint8_t* in, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= static_cast<std::uint64_t>(in[i]) << (8 * i);
  return value;
}

Error damaged(const fs::path& file, const std::string& how) {
  return {ErrorCode::kIo,
          file.string() + ": " + how + "; `overfly world build` repairs the world's cache"};
}

Result<Bytes> read_piece(std::ifstream& in, const fs::path& file, int index) {
  in.seekg(0);
  std::uint8_t head[kHeadBytes];
  if (!in.read(reinterpret_cast<char*>(head), kHeadBytes)) {
    return damaged(file, "is missing or truncated");
  }
  if (std::memcmp(head, kMagic, kMagicBytes) != 0 ||
      static_cast<std::uint64_t>(index) >= get(head + kMagicBytes, 4)) {
    return damaged(file, "is not a part of this cache");
  }
  std::uint8_t row[kRowBytes];
  in.seekg(static_cast<std::streamoff>(kHeadBytes + kRowBytes * static_cast<std::size_t>(index)));
  if (!in.read(reinterpret_cast<char*>(row), kRowBytes)) return damaged(file, "is truncated");
  constexpr std::uint64_t kLargest = std::uint64_t{64} << 20U;
  const std::uint64_t size = get(row + 8, 4);
  if (size > kLargest) return damaged(file, "is damaged");
  Bytes piece(size);
  in.seekg(static_cast<std::streamoff>(get(row, 8)));
  if (!in.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(size))) {
    return damaged(file, "is truncated");
  }
  if (adler32(piece) != get(row + 12, 4)) return damaged(file, "is damaged");
  return piece;
}

}  // namespace

Status write_whole(const fs::path& file, std::span<const std::uint8_t> bytes) {
  static std::atomic<unsigned> count{0};
  const fs::path part =
      file.string() + ".part" + std::to_string(getpid()) + "-" + std::to_string(count++);
  std::error_code failed;
  fs::create_directories(file.parent_path(), failed);
  bool written = false;
  {
    std::ofstream out(part, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    written = static_cast<bool>(out.flush());
  }
  const std::string reason = std::strerror(errno);
  if (written) fs::rename(part, file, failed);
  if (!written || failed) {
    const std::string why = written ? failed.message() : reason;
    fs::remove(part, failed);
    return Error{ErrorCode::kIo, file.string() + ": cannot be written: " + why};
  }
  return {};
}

Status write_chunk(const fs::path& file, const std::vector<Bytes>& pieces) {
  Bytes bytes(kMagic, kMagic + kMagicBytes);
  put(bytes, pieces.size(), 4);
  std::uint64_t offset = kHeadBytes + kRowBytes * pieces.size();
  for (const Bytes& piece : pieces) {
    put(bytes, offset, 8);
    put(bytes, piece.size(), 4);
    put(bytes, adler32(piece), 4);
    offset += piece.size();
  }
  for (const Bytes& piece : pieces) bytes.insert(bytes.end(), piece.begin(), piece.end());
  return write_whole(file, bytes);
}

Status check_chunk(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::uint8_t head[kHeadBytes];
  if (!in.read(reinterpret_cast<char*>(head), kHeadBytes)) {
    return damaged(file, "is missing or truncated");
  }
  // A power loss may leave zeros on the disk.
  const auto count = static_cast<int>(get(head + kMagicBytes, 4));
  if (count <= 0) return damaged(file, "is damaged");
  for (int i = 0; i < count; ++i) {
    const auto piece = read_piece(in, file, i);
    if (!piece) return piece.error();
  }
  return {};
}

Result<Bytes> read_piece(const fs::path& file, int index) {
  std::ifstream in(file, std::ios::binary);
  return read_piece(in, file, index);
}

}  // namespace overfly::terrain
