// FFmpeg's libraries are loaded when the first video is opened: what is missing must be an error
// that names it, not the end of the program.
#include "server/imagery/video/ffmpeg_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/result.hpp"

namespace overfly::server {
namespace {

using ::testing::HasSubstr;

TEST(FfmpegLibrary, NamesALibraryThatIsMissing) {
  const Result<void*> library = load_library("liboverfly_absent.so.1");
  ASSERT_FALSE(library);
  EXPECT_EQ(library.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(library.error().message, HasSubstr("liboverfly_absent.so.1"));
}

TEST(FfmpegLibrary, NamesAFunctionThatALibraryLacks) {
  const Result<void*> library = load_library("libc.so.6");
  ASSERT_TRUE(library) << library.error().message;
  EXPECT_TRUE(find_function(*library, "strlen"));
  const Result<void*> function = find_function(*library, "av_absent_function");
  ASSERT_FALSE(function);
  EXPECT_EQ(function.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(function.error().message, HasSubstr("av_absent_function"));
}

}  // namespace
}  // namespace overfly::server
