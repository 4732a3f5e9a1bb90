// The parts of an MCAP file that are read for a slice, by the file's own index.
#pragma once

#include <atomic>
#include <filesystem>
#include <vector>

#include "core/result.hpp"
#include "flight/logs/index/log_index.hpp"

namespace overfly::flight::logs {

/// Uses the chunk indexes of the file's summary, after it has compared them with the file.
///
/// They have times of recording, a slice those of the messages' stamps. All messages of the parts,
/// and of 16 chunks from the whole file (at most 64 MiB), are therefore read once: stamps must lie
/// within 2 s of the times of recording, and these within their chunk's. Times of a chunk that is
/// not read are taken from its header.
/// @param cancel  may be null
/// @return as parts_for: with what declares topics and proves their clocks; everything that is in
/// no indexed chunk is read. Empty if that were more than half of the file: its index of our own is
/// then made at little cost.
/// Errors: kNotFound without a summary with chunk indexes; kUnreadable saying what is wrong; kIo;
/// kCancelled.
[[nodiscard]] Result<std::vector<FileRange>> mcap_parts_for(const std::filesystem::path& file,
                                                            const LogSlice& slice,
                                                            const std::atomic<bool>* cancel);

}  // namespace overfly::flight::logs
