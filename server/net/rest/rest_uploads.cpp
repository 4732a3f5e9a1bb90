#include "server/net/rest/rest_uploads.hpp"

#include <optional>
#include <span>
#include <utility>

#include "server/net/http/error_response.hpp"

namespace overfly::net {

using nlohmann::json;
using server::UploadRefusal;

namespace {

class UploadSink final : public BodySink {
 public:
  UploadSink(std::unique_ptr<server::LogUpload> upload,
             std::function<json(const std::filesystem::path&)> entry_of,
             std::string address)
      : upload_(std::move(upload)), entry_of_(std::move(entry_of)), address_(std::move(address)) {}

  [[nodiscard]] std::optional<HttpResponse> write(std::span<const std::uint8_t> bytes) override {
    const Status written = upload_->write(bytes);
    if (written) return std::nullopt;
    return upload_refused(upload_->refusal(), written.error());
  }
  [[nodiscard]] HttpResponse finish() override {
    const auto file = upload_->finish();
    if (!file) return upload_refused(upload_->refusal(), file.error());
    const json entry = entry_of_(*file);
    std::string name = entry.at("name");
    // Plain names: only the slashes between them need an escape.
    for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at)) {
      name.replace(at, 1, "%2F");
    }
    HttpResponse response = json_response(201, entry);
    response.headers.emplace_back("Location", address_ + name);
    return response;
  }

 private:
  std::unique_ptr<server::LogUpload> upload_;
  std::function<json(const std::filesystem::path&)> entry_of_;
  std::string address_;
};

}  // namespace

HttpResponse upload_refused(UploadRefusal refusal, const Error& error) {
  switch (refusal) {
    case UploadRefusal::kNone:
      break;
    case UploadRefusal::kOff:
      return error_response(403, "forbidden", error.message);
    case UploadRefusal::kBusy:
      return error_response(503, "too_many_uploads", error.message);
    case UploadRefusal::kTooLarge:
      return error_response(413, "payload_too_large", error.message);
    case UploadRefusal::kQuota:
      return error_response(507, "quota_exceeded", error.message);
    case UploadRefusal::kNotALog:
      return error_response(422, "unreadable", error.message);
  }
  return error_response(error);
}

std::unique_ptr<BodySink> upload_sink(std::unique_ptr<server::LogUpload> upload,
                                      std::function<json(const std::filesystem::path&)> entry_of,
                                      std::string address) {
  return std::make_unique<UploadSink>(std::move(upload), std::move(entry_of), std::move(address));
}

HttpResponse removed_response(const Status& removed) {
  if (!removed) {
    const bool foreign = removed.error().code == ErrorCode::kInvalidArgument;
    return foreign ? error_response(403, "forbidden", removed.error().message)
                   : error_response(removed.error());
  }
  HttpResponse response;
  response.status = 204;
  return response;
}

}  // namespace overfly::net
