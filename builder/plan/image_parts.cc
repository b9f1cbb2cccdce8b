// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/image_parts.h"

#include "builder/plan/distractors.h"
#include "builder/plan/image_material.h"
#include "builder/plan/image_scene.h"

#include <utility>

namespace ds {

ImageParts parts_of(const ImageSpec& image, const Recipe& recipe, Inputs& inputs) {
  ImageParts parts{&inputs.environment(image.environment_folder),
                   image.environment_folder,
                   {},
                   change_of(image, recipe, inputs),
                   {},
                   image.lights};
  if (!parts.change.values.empty())
    parts.nodes = inputs.environment_facts(image.environment_folder).nodes;
  for (const Distractor& one : *image.distractors) {
    parts.objects.push_back({{one.id(), distractor_name(one)},
                             material_of(one, recipe, inputs),
                             inputs.model_source(one.model.file, normalise_of(one, recipe))});
    parts.objects.back().source.shared = true;
  }
  parts.objects.push_back({{},
                           material_of(image, recipe, inputs),
                           inputs.model_source(image.model_file, normalise_of(image, recipe))});
  return parts;
}

Scene scene_of(const ImageParts& parts, ModelMeshes& meshes) {
  Scene scene = parts.change.values.empty() ? *parts.environment
                                            : with_node_values(*parts.environment, parts.nodes,
                                                               parts.folder, parts.change.values);
  scene = changed(std::move(scene), parts.change);
  scene.lights.insert(scene.lights.end(), parts.lights.begin(), parts.lights.end());
  for (const ShownObject& object : parts.objects)
    add_object(scene, object.material, meshes.get(object.source), object.called);
  return scene;
}

}  // namespace ds
