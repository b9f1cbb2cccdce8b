// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/schema.h"

#include "builder/cmd/verbs.h"
#include "manifests/json_text.h"
#include "manifests/manifest_schema.h"
#include "tracer/base/error.h"
#include "tracer/base/nearest.h"
#include "tracer/base/streams.h"

#include <nlohmann/json.hpp>

#include <string_view>
#include <utility>
#include <vector>

namespace ds {
namespace {

constexpr std::pair<std::string_view, nlohmann::json (*)()> k_schemas[] = {
    {"recipe", recipe_schema}, {"images", image_schema}, {"dataset", dataset_schema}};

}  // namespace

std::vector<std::string> schema_names() {
  std::vector<std::string> names;
  for (const auto& [name, schema] : k_schemas)
    names.emplace_back(name);
  return names;
}

int run_schema(const Arguments& arguments) {
  std::vector<std::string_view> known;
  for (const auto& [name, schema] : k_schemas) {
    if (name == arguments.schema) {
      say(Stream::result, "{}", canonical_json(schema(), 2));
      return 0;
    }
    known.push_back(name);
  }
  fail(ErrorKind::usage, "schema: wanted {}, got {}{}", fmt::format("{}", fmt::join(known, ", ")),
       arguments.schema, did_you_mean(arguments.schema, known));
}

}  // namespace ds
