// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace ds {

/// The machine's name; empty where the system does not tell. For the build log only.
std::string host_name();

}  // namespace ds
