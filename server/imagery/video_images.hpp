// The frames of a video.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>

#include "core/result.hpp"
#include "server/imagery/image_source.hpp"

namespace overfly::server {

/// Whether this build reads videos.
[[nodiscard]] bool reads_videos();

/// Opens the first video stream of a file: WebM, Matroska, MP4, AVI, MPEG-TS. The stamps are the
/// presentation times of the frames. Only this file is read, never another one or the network.
/// Memory: 8 bytes a frame and what the decoder needs.
/// Errors: kUnsupported if this build does not read videos; kUnreadable: no video of these formats,
/// no frames or more than two million, frames of more than 8192 x 8192 px; kIo; kCancelled.
[[nodiscard]] Result<std::unique_ptr<ImageSource>> open_video_images(
    const std::filesystem::path& file, const std::atomic<bool>* cancel);

}  // namespace overfly::server
