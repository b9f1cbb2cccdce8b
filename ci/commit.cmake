# SPDX-License-Identifier: Apache-2.0
# Writes OUT, a header with the commit that SOURCE is at, "+" behind it where files differ; leaves it where that is what
# it says. "unknown" where there is no git or no repository.
execute_process(COMMAND git -C "${SOURCE}" describe --always --abbrev=12 --dirty=+ --exclude=*
  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
if(failed OR commit STREQUAL "")
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT "${OUT}" CONTENT "// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace ds {
inline constexpr const char* k_commit = \"${commit}\";
}  // namespace ds
")
