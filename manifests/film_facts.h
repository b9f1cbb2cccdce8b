// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace ds {

/// What is known of an image's film, as the object "film" of a manifest's line; the database and
/// the store's records hold the same text. The fields are FilmFacts'; what is not known is null.
nlohmann::json to_json_value(const FilmFacts& facts);
/// Fields that are not there keep their defaults: an older dsbuild wrote fewer. Throws
/// Error(asset) with the field's name for a value of another type.
FilmFacts film_facts_from(const nlohmann::json& object);

std::string to_text(const FilmFacts& facts);
/// "" is what nothing is known of. Throws Error(asset) for what `to_text` did not write.
FilmFacts film_facts_from_text(const std::string& text);

}  // namespace ds
