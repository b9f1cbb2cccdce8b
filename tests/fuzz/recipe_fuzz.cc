// SPDX-License-Identifier: Apache-2.0
// Recipes: the first line is a --set text, the rest the file. All but the search for assets, which
// needs a disk.
#include "builder/recipe/camera_sets.h"
#include "builder/recipe/settings.h"
#include "builder/recipe/value.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t first_line = std::min(text.find('\n'), text.size());
  ds::Diagnostics diagnostics(ds::ErrorKind::recipe);
  ds::RecipeValue::Table tree =
      ds::parse_recipe_text(text.substr(first_line), "fuzz.toml", diagnostics);
  ds::apply_override(text.substr(0, first_line), tree, diagnostics);
  ds::Settings settings("fuzz.toml", std::move(tree), diagnostics);
  const ds::CameraViews views = ds::make_cameras(settings, ds::constants_of(settings));
  DS_ASSERT(views.cameras.size() == views.names.size());
  for (const ds::KeySpec& key : ds::recipe_keys()) {
    const ds::RecipeValue* value = settings.find(key.name);
    DS_ASSERT(value == nullptr || settings.distribution(key.name) != nullptr ||
              ds::fits(key, *value));
  }
  return 0;
}
