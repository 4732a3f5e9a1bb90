#include "server/imagery/video/ffmpeg_library.hpp"

#include <dlfcn.h>

#include <string>

namespace overfly::server {
namespace {

Error not_loaded(const std::string& name) {
  const char* const why = dlerror();
  return {ErrorCode::kUnsupported,
          "videos need FFmpeg's libraries: " + (why != nullptr ? why : name + " is missing")};
}

/// A library whose functions are looked up one by one; the first failure is kept.
class LoadedLibrary {
 public:
  explicit LoadedLibrary(const char* name) : library_(load_library(name)) {}

  template <typename Function>
  void find(const char* name, Function& function) {
    if (!library_) return;
    const Result<void*> found = find_function(*library_, name);
    if (found) {
      function = reinterpret_cast<Function>(*found);
    } else {
      library_ = found;
    }
  }
  [[nodiscard]] Status status() const { return library_ ? Status() : Status(library_.error()); }

 private:
  Result<void*> library_;
};

Result<Ffmpeg> load_functions() {
  LoadedLibrary avutil("libavutil.so." AV_STRINGIFY(LIBAVUTIL_VERSION_MAJOR));
  LoadedLibrary avcodec("libavcodec.so." AV_STRINGIFY(LIBAVCODEC_VERSION_MAJOR));
  LoadedLibrary avformat("libavformat.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR));
  LoadedLibrary swscale("libswscale.so." AV_STRINGIFY(LIBSWSCALE_VERSION_MAJOR));
  Ffmpeg functions;
#define OVERFLY_FFMPEG_FIND(library, function) library.find(#function, functions.function);
  OVERFLY_FFMPEG_FUNCTIONS(OVERFLY_FFMPEG_FIND)
#undef OVERFLY_FFMPEG_FIND
  for (const LoadedLibrary* library : {&avutil, &avcodec, &avformat, &swscale}) {
    if (Status status = library->status(); !status) return status.error();
  }
  functions.av_log_set_level(AV_LOG_QUIET);
  return functions;
}

const Result<Ffmpeg>& loaded() {
  static const Result<Ffmpeg> functions = load_functions();
  return functions;
}

}  // namespace

Result<void*> load_library(const char* name) {
  // At once: a function that a library lacks is an error here, and would end the program later.
  void* const library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return not_loaded(name);
  return library;
}

Result<void*> find_function(void* library, const char* name) {
  void* const function = dlsym(library, name);
  if (function == nullptr) return not_loaded(name);
  return function;
}

Status load_ffmpeg() { return loaded() ? Status() : Status(loaded().error()); }

const Ffmpeg& ffmpeg() { return *loaded(); }

}  // namespace overfly::server
