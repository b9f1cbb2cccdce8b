// SPDX-License-Identifier: Apache-2.0
#include "builder/import/recipe_text.h"

#include "builder/recipe/value.h"

#include <fmt/format.h>

namespace ds {
namespace {

std::string classes_text(const RecipeFacts& facts) {
  std::string text =
      "[classes]\n"
      "from = \"classes.csv\"  # name, class, split: edit it, or add lines for new models\n"
      "unlisted = \"skip\"  # models that it does not list, as those that cannot be read\n";
  if (facts.has_classes)
    text += "ids = \"ids.txt\"  # a class's id is its line, from 0: add new ones at the end\n";
  if (!facts.more.empty()) {
    std::string files;
    for (const std::string& file : facts.more)
      files += (files.empty() ? "" : ", ") + to_toml(file);
    text += fmt::format("more = [{}]  # further classifications\n", files);
  }
  if (!facts.has_splits)
    text += fmt::format(
        "split = {{ test = 0.25{} }}  # a quarter of {} models, by their names' hash; "
        "val = 0.15 beside it\n",
        facts.has_classes ? ", stratified = true" : "", facts.has_classes ? "each class's" : "the");
  return text;
}

}  // namespace

std::string recipe_text(const RecipeFacts& facts) {
  return fmt::format(
      R"(# Made by dsbuild import of {}.
# See a small view of it first, and whether the models stand upright:
#   dsbuild build recipe.toml -o preview --set 'camera.views=[1]' --set engine.width=64 --set engine.height=64 --set engine.error=0.3
# Every key: dsbuild help recipe

[dataset]
name = {}
seed = 0
licence = ""  # of the pictures, for the manifest and exports

[models]
dir = {}
recursive = true
names = "{}"  # "path" where file names repeat
up = "y"  # "z" where the models lie on their backs
size_m = 0.16  # longest side; 0 takes the files' lengths as metres
ground_z_m = -0.0574
centre = "mass"

{}
[materials]
dir = "materials"
assign = "random"
{}
[environments]
dir = "environments"
assign = "cycle"

[camera]
set = "half-dodecahedron"  # 14 views
distance_m = "fit"  # each model fills its picture, and none is cut off
fov_deg = 49

[engine]
width = 256
height = 256
error = 0.05  # smaller is cleaner and takes longer: dsbuild plan recipe.toml --time
max_spp = 256

[outputs]
image = "png"
mask = true
)",
      to_toml(facts.from), to_toml(facts.name), to_toml(facts.models_dir),
      facts.names_by_path ? "path" : "file", classes_text(facts),
      facts.own.empty()
          ? ""
          : fmt::format("# {} have materials of their own: assign = \"own\" in place of these two "
                        "lines shows them\n",
                        facts.own));
}

}  // namespace ds
