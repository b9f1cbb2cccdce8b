// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"

#include <string>
#include <string_view>

namespace ds {

/// canonical_engine and canonical_kept_engine with the program's comment-stripped text given
/// (program_text.h): making it takes a millisecond, and a dataset's images have few different ones.
std::string canonical_engine(const EngineSettings& engine, std::string_view program);
std::string canonical_kept_engine(const EngineSettings& engine, std::string_view program);

}  // namespace ds
