// What the routes of uploads share: the body of a request as an upload, and its answers.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/logs/log_uploads.hpp"
#include "server/net/http/body_sink.hpp"
#include "server/net/http/http_message.hpp"

namespace overfly::net {

/// The answer to an upload that is refused.
[[nodiscard]] HttpResponse upload_refused(server::UploadRefusal refusal, const Error& error);

/// An upload as the body of a request. The answer is 201 with its entry, and its address in
/// `Location`. @param entry_of  the entry of a finished upload, with `name`
/// @param address  of the resources: "/api/v1/logs/"
[[nodiscard]] std::unique_ptr<BodySink> upload_sink(
    std::unique_ptr<server::LogUpload> upload,
    std::function<nlohmann::json(const std::filesystem::path&)> entry_of,
    std::string address);

/// 204, or the error; 403 for what was not uploaded.
[[nodiscard]] HttpResponse removed_response(const Status& removed);

}  // namespace overfly::net
