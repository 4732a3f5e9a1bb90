// The log writer where LCM is not built in.
#include "vo_bridges/lcm/lcm_log_writer.hpp"

namespace overfly {

Result<std::unique_ptr<LcmLogWriter>> LcmLogWriter::create(const std::filesystem::path& /*file*/,
                                                           std::int64_t /*epoch_utc_ns*/) {
  return Error{ErrorCode::kUnsupported,
               "this build does not speak LCM: install liblcm-dev and liblcm-bin, and build again"};
}

}  // namespace overfly
