#include "terrain/raster/gdal_messages.hpp"

#include <algorithm>
#include <utility>

namespace overfly::terrain {

namespace {

/// The object that receives the messages of this thread.
GdalMessages*& innermost() {
  thread_local GdalMessages* messages = nullptr;
  return messages;
}

/// Removes "/." and "//." from names of files: open_raster spells folders with them.
std::string plain_names(std::string line) {
  std::size_t at = 0;
  while ((at = line.find("/./", at)) != std::string::npos) {
    const bool twice = at > 0 && line[at - 1] == '/';
    line.erase(at, twice ? 3 : 2);
    if (at > 0) --at;
  }
  return line;
}

}  // namespace

GdalMessages::GdalMessages() : outer_(innermost()) {
  innermost() = this;
  CPLPushErrorHandlerEx(&GdalMessages::collect, this);
}

GdalMessages::~GdalMessages() {
  CPLPopErrorHandler();
  innermost() = outer_;
}

void CPL_STDCALL GdalMessages::collect(CPLErr severity, CPLErrorNum, const char* message) {
  if (severity < CE_Warning) return;
  static_cast<GdalMessages*>(CPLGetErrorHandlerUserData())->add(message);
}

void GdalMessages::add(std::string line) {
  constexpr std::size_t kLongest = 600;
  if (text_.size() > kLongest) return;
  std::replace(line.begin(), line.end(), '\n', ' ');
  line = plain_names(std::move(line));
  while (!line.empty() && line.back() == ' ') line.pop_back();
  if (text_.find(line) != std::string::npos) return;
  if (!text_.empty()) text_ += "; ";
  text_ += line;
}

void GdalMessages::pass_on() const {
  if (outer_ != nullptr && !text_.empty()) outer_->add(text_);
}

std::string GdalMessages::text() const { return text_.empty() ? "no reason given" : text_; }

std::string heard_while_opening(const std::filesystem::path& file, const GdalMessages& messages) {
  return file.string() + ": GDAL reported on opening it: " + messages.text();
}

}  // namespace overfly::terrain
