#include "server/files/program_identity.hpp"

#include "server/files/build_info.hpp"
#include "server/files/file_stamp.hpp"

namespace overfly::server {

std::string program_identity() {
  const std::string commit = git_commit();
  const std::string known = version() + " " + commit;
  if (commit != "unknown" && !commit.ends_with("-dirty")) return known;
  const FileStamp stamp = FileStamp::of("/proc/self/exe");
  return known + " " + std::to_string(stamp.size_bytes) + " bytes of " +
         std::to_string(stamp.modified_ns);
}

}  // namespace overfly::server
