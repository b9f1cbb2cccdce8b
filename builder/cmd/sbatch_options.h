// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace ds {

/// Throws Error(usage) for options of sbatch that take away what `dsbuild slurm` gives it itself
/// (which shares there are, where their logs go, what waits for what, that a job is requeued), that
/// take more of a node than a job uses, that let it submit nothing, and for words that it would run
/// in place of the script. As sbatch reads them: "-a1-3", "-Ha", "--arr=1-3".
void check_sbatch_options(const std::vector<std::string>& words);

}  // namespace ds
