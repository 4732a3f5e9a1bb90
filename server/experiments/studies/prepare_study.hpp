// Checks what a client asks of a study, before anything is flown or drawn.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/studies/study_record.hpp"
#include "server/runs/run_manager.hpp"

namespace overfly::server::experiments {

/// Checks a request as the scenario of a run is checked, and writes its inputs and its record into
/// a folder: files must lie in the data folders, commands and addresses must be those of the
/// owner's scenarios, and each flight must fit in the memory.
/// @param folder  exists
/// Errors: kNotFound for run and scenario; kInvalidArgument naming the field; kConflict for a run
/// that has not ended, and with `refusal`; as resolve_hunt; kIo.
[[nodiscard]] Result<StudyRecord> prepare_study(RunManager& runs,
                                                const StudyRequest& request,
                                                const StudyFolder& folder,
                                                StudyRefusal& refusal,
                                                const std::atomic<bool>* cancel);

/// Whether a study that was made before may be made again now: commands, addresses and memory.
/// Errors: as prepare_study.
[[nodiscard]] Status check_again(RunManager& runs,
                                 const StudyRecord& record,
                                 const StudyFolder& folder,
                                 StudyRefusal& refusal);

/// The arguments of the program that makes a study: command, input, options, and the files that it
/// may read. Errors: kNotFound if the run is gone.
[[nodiscard]] Result<std::vector<std::string>> study_arguments(const RunManager& runs,
                                                               const StudyRecord& record,
                                                               const StudyFolder& folder);

}  // namespace overfly::server::experiments
