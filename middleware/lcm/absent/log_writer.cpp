// LCM log writer of a build without LCM.
#include "middleware/lcm/log_writer.hpp"

namespace overfly::lcm {

Result<std::unique_ptr<LogWriter>> LogWriter::create(const std::filesystem::path& /*file*/,
                                                     std::int64_t /*epoch_utc_ns*/) {
  return Error{ErrorCode::kUnsupported,
               "this build has no LCM support: install liblcm-dev and liblcm-bin, and rebuild"};
}

}  // namespace overfly::lcm
