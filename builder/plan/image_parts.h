// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/recipe/recipe.h"
#include "tracer/scene/scene.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/vary.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ds {

/// A thing that an image shows in its environment.
struct ShownObject {
  ObjectName called;
  Scene material;
  ModelSource source;
};

/// What an image's scene is made of: found out in one thread, it can be put together in another.
struct ImageParts {
  const Scene* environment = nullptr;  ///< of the Inputs asked
  std::filesystem::path folder;        ///< of the environment
  std::string nodes;                   ///< EnvironmentFacts::nodes, where the change has values
  EnvironmentChange change;
  std::vector<ShownObject> objects;  ///< the model last
  std::vector<Light> lights;         ///< beside the environment's
};

/// Throws where a file cannot be read.
ImageParts parts_of(const ImageSpec& image, const Recipe& recipe, Inputs& inputs);
/// The whole scene. Throws what ModelMeshes::get and add_object throw.
Scene scene_of(const ImageParts& parts, ModelMeshes& meshes);

}  // namespace ds
