// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace ds {

/// Sets what PoCL reads from the environment when it starts; a variable that the user has set is
/// left as it is.
///
/// - POCL_CACHE_DIR: a fresh folder of this process under `default_cache_folder()`/pocl. PoCL's
///   default lies in HOME, and where that cannot be written it offers no device at all.
/// - POCL_KERNEL_CACHE=0: PoCL keeps nothing for later processes. It loads what it finds in its
///   cache unchecked, a file torn by a crash too; `load_program` checks what it loads, and is as
///   fast.
/// - POCL_WORK_GROUP_SPECIALIZATION=0: one machine code for every local size, offset and grid size.
///   Otherwise PoCL compiles anew, about half a second each, at the first launch with another one,
///   and a stored binary misses it.
///
/// Must come before the first OpenCL call of the process; later calls do nothing. It calls setenv:
/// no other thread may use the environment meanwhile. Folders of processes that have ended are
/// removed. Throws Error(io), and Error(device) with the variable's name where the POCL_CACHE_DIR
/// that is set is no folder that can be read and written.
void prepare_pocl_environment();

/// The variables that can change what PoCL compiles, sorted, one "NAME=value" a line.
std::string pocl_environment();

}  // namespace ds
