// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A folder with models, materials, environments and class files of no content: what a recipe needs
/// to be read.
class RecipeFolder {
 public:
  RecipeFolder() {
    for (const char* model : {"car.ply", "mug.off", "tree.PLY"})
      add(std::string("models/") + model);
    add("models/notes.txt");
    add("models/.hidden.ply");
    for (const char* material : {"steel", "clay", "glass"})
      add(std::string("materials/") + material + ".mat");
    for (const char* place : {"garden", "attic"})
      add(std::string("places/") + place + "/environment.scn");
    add("places/textures/wood.png");
  }

  const std::filesystem::path& path() const { return temporary_.path(); }
  void add(const std::string& file, std::string_view text = "") const {
    make_folders((path() / file).parent_path());
    std::ofstream out(path() / file, std::ios::binary);
    out << text;
  }

  /// The sections that every recipe must have.
  static constexpr std::string_view k_assets =
      "models.dir = \"models\"\nmaterials.dir = \"materials\"\nenvironments.dir = \"places\"\n";

  /// Reads a recipe of these sections and `text` behind them.
  Recipe read(std::string_view text = "", const std::vector<std::string>& overrides = {}) const {
    return read_whole(std::string(k_assets) + std::string(text), overrides);
  }
  Recipe read_whole(std::string_view text, const std::vector<std::string>& overrides = {}) const {
    add("r.toml", text);
    return read_recipe(path() / "r.toml", overrides);
  }

  /// All findings, the folder's own name taken out; "" where there are none.
  std::string findings(std::string_view text,
                       const std::vector<std::string>& overrides = {}) const {
    return findings_whole(std::string(k_assets) + std::string(text), overrides);
  }
  std::string findings_whole(std::string_view text,
                             const std::vector<std::string>& overrides = {}) const {
    try {
      read_whole(text, overrides);
    } catch (const Error& error) {
      std::string what = error.kind() == ErrorKind::recipe ? "" : "of another kind: ";
      what += error.what();
      const std::string folder = path().string() + "/";
      for (std::size_t at = what.find(folder); at != what.npos; at = what.find(folder))
        what.erase(at, folder.size());
      return what;
    }
    return "";
  }

 private:
  TemporaryFolder temporary_;
};

}  // namespace ds
