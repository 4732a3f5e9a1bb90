#include "flight/mavlink/link/signing.hpp"

#include <algorithm>
#include <string>

#include "core/measure/sha256.hpp"
#include "core/outside/file_text.hpp"

namespace overfly::flight::mavlink {
namespace {

/// Seconds from 1970 to 2015.
constexpr std::int64_t kSigningEpochS = 1'420'070'400;
constexpr std::uint64_t kUnitsPerMinute = 60 * 100'000;
/// Senders that are remembered. With the key, a peer could make up to 2^24.
constexpr std::size_t kMaxSigners = 1024;
constexpr std::uint64_t kMaxKeyFileBytes = 4096;

std::array<std::uint8_t, 6> bytes_of_time(std::uint64_t timestamp) {
  std::array<std::uint8_t, 6> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(timestamp >> (8 * i));
  }
  return bytes;
}

std::optional<unsigned> hex_digit(char digit) {
  if (digit >= '0' && digit <= '9') return static_cast<unsigned>(digit - '0');
  if (digit >= 'a' && digit <= 'f') return static_cast<unsigned>(digit - 'a' + 10);
  if (digit >= 'A' && digit <= 'F') return static_cast<unsigned>(digit - 'A' + 10);
  return std::nullopt;
}

}  // namespace

std::uint64_t signing_time(std::chrono::system_clock::time_point utc) {
  const auto us =
      std::chrono::duration_cast<std::chrono::microseconds>(utc.time_since_epoch()).count() -
      kSigningEpochS * 1'000'000;
  return us < 0 ? 0 : static_cast<std::uint64_t>(us) / 10;
}

std::array<std::uint8_t, 6> signature_of(const SigningKey& key,
                                         std::span<const std::uint8_t> frame,
                                         std::uint8_t link_id,
                                         std::uint64_t timestamp) {
  Sha256 hash;
  hash.add(key);
  hash.add(frame);
  hash.add({&link_id, 1});
  hash.add(bytes_of_time(timestamp));
  const Sha256::Digest digest = hash.finish();
  std::array<std::uint8_t, 6> signature{};
  std::copy_n(digest.begin(), signature.size(), signature.begin());
  return signature;
}

Result<std::vector<std::uint8_t>> encode_signed_frame(const Frame& frame,
                                                      const SigningKey& key,
                                                      std::uint8_t link_id,
                                                      std::uint64_t timestamp) {
  Frame flagged = frame;
  flagged.is_signed = true;
  Result<std::vector<std::uint8_t>> bytes = encode_frame(flagged);
  if (!bytes) return bytes;
  const auto signature = signature_of(key, *bytes, link_id, timestamp);
  const auto time = bytes_of_time(timestamp);
  bytes->push_back(link_id);
  bytes->insert(bytes->end(), time.begin(), time.end());
  bytes->insert(bytes->end(), signature.begin(), signature.end());
  return bytes;
}

Result<SigningKey> read_signing_key(const std::filesystem::path& file) {
  Result<std::string> text = read_file_text(file, kMaxKeyFileBytes);
  if (!text) return text.error();
  SigningKey key{};
  std::size_t digits = 0;
  bool valid = true;
  for (const char c : *text) {
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') continue;
    const std::optional<unsigned> value = hex_digit(c);
    if (!value || digits >= 2 * key.size()) {
      valid = false;
      break;
    }
    key[digits / 2] = static_cast<std::uint8_t>((key[digits / 2] << 4U) | *value);
    ++digits;
  }
  if (!valid || digits != 2 * key.size()) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": a signing key must be 64 hexadecimal digits"};
  }
  return key;
}

void SignatureCheck::advance(std::uint64_t timestamp) {
  timestamp_ = std::max(timestamp_, timestamp);
}

bool SignatureCheck::accepts(const Frame& frame, std::span<const std::uint8_t> bytes) {
  if (!frame.is_signed || bytes.size() < kSignatureBytes) return false;
  const std::span<const std::uint8_t> tail = bytes.last(kSignatureBytes);
  const std::uint8_t link_id = tail[0];
  std::uint64_t timestamp = 0;
  for (unsigned i = 0; i < 6; ++i) timestamp |= std::uint64_t{tail[1 + i]} << (8U * i);
  const auto expected =
      signature_of(key_, bytes.first(bytes.size() - kSignatureBytes), link_id, timestamp);
  unsigned difference = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) difference |= expected[i] ^ tail[7 + i];
  if (difference != 0) return false;
  const std::uint32_t sender =
      (std::uint32_t{frame.system} << 16U) | (std::uint32_t{frame.component} << 8U) | link_id;
  const auto known = latest_.find(sender);
  if (known != latest_.end()) {
    if (timestamp <= known->second) return false;
    known->second = timestamp;
  } else {
    if (timestamp + kUnitsPerMinute < timestamp_ || latest_.size() >= kMaxSigners) return false;
    latest_.emplace(sender, timestamp);
  }
  advance(timestamp);
  return true;
}

}  // namespace overfly::flight::mavlink
