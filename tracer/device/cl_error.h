// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace ds {

/// The name of an OpenCL error code as the specification spells it, such as "CL_OUT_OF_RESOURCES";
/// "error -9999" for a code that no specification names.
std::string cl_error_name(int code);

}  // namespace ds
