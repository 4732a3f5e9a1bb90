#include "flight/logs/record_pass.hpp"

#include <algorithm>

namespace overfly::flight::logs {

Result<std::uint64_t> pass_over(ForwardReader& file,
                                std::uint64_t bytes,
                                const std::function<void(std::span<const std::uint8_t>)>& seen) {
  std::uint64_t passed = 0;
  while (passed < bytes) {
    const Result<std::span<const std::uint8_t>> ahead = file.ahead(1);
    if (!ahead) return ahead.error();
    if (ahead->empty()) break;
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(bytes - passed, ahead->size()));
    if (seen) seen(ahead->first(count));
    file.skip(count);
    passed += count;
  }
  return passed;
}

Status take_all_records(ForwardReader& file,
                        LogSink& sink,
                        const std::function<Result<bool>()>& take_record) {
  std::uint64_t next_progress = 0;
  while (true) {
    const Result<bool> more = take_record();
    if (!more) return more.error();
    if (!*more) return {};
    if (file.position() < next_progress) continue;
    next_progress = file.position() + ForwardReader::kBufferBytes;
    if (!sink.progress(file.position())) {
      return Error{ErrorCode::kCancelled, "reading was cancelled"};
    }
  }
}

}  // namespace overfly::flight::logs
