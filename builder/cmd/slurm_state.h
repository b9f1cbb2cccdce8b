// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/slurm_mark.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace ds {

/// What Slurm says of a mark's jobs.
enum class SlurmState { running, gone, unknown };  ///< waiting is running; unknown: Slurm is mute
SlurmState state_of(const SlurmMark& mark);

/// "jobs 17, 18 of anna, submitted on login1 at 2024-02-29 12:00:00 UTC, in 8 shares".
std::string jobs_text(const SlurmMark& mark);
/// The same and the jobs' state.
std::string to_text(const SlurmMark& mark);
nlohmann::json to_json(const SlurmMark& mark);

/// Throws Error(usage) where the mark's jobs fill the store now, or may: `what` ("a plain build") keeps
/// a database and locks in the store, of which they know nothing.
void refuse_filled_store(const SlurmMark& mark, std::string_view what);

}  // namespace ds
