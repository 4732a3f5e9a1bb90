// Several files that are uploaded together: a mapping of CSV files and its pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::server {

/// One of the files, in the order in which they are sent: the mapping first.
struct UploadFile {
  std::string name;
  std::uint64_t size_bytes = 0;
};
inline constexpr std::size_t kMaxUploadFiles = 33;  ///< a mapping and its pieces

/// Checks number, names and sizes before anything is received.
/// Errors: kInvalidArgument naming the file and the limit.
[[nodiscard]] Status check_upload_set(const std::vector<UploadFile>& files,
                                      std::uint64_t max_bytes);

/// Checks that a mapping which was received names the files that came with it, all of them and no
/// others. @param folder  in which the files lie; messages do not contain it
/// Errors: kUnreadable.
[[nodiscard]] Status check_uploaded_mapping(const std::filesystem::path& folder,
                                            const std::vector<UploadFile>& files);

}  // namespace overfly::server
