// SPDX-License-Identifier: Apache-2.0
// What keys are made of, of an image or a model alone.
#include "builder/plan/keys.h"
#include "tracer/base/canonical.h"

#include <span>

namespace ds {
namespace {

const char* name_of(Centring centre) {
  return centre == Centring::none ? "none" : centre == Centring::mass ? "mass" : "box";
}

const char* name_of(Normals normals) {
  return normals == Normals::smooth ? "smooth" : normals == Normals::keep ? "keep" : "flat";
}

}  // namespace

const ToneMap& tone_map_of(const Recipe& recipe, const Scene& environment) {
  return recipe.outputs.tone_map ? *recipe.outputs.tone_map : environment.tone_map;
}
const ToneMap& tone_map_of(const Recipe& recipe, const EnvironmentFacts& environment) {
  return recipe.outputs.tone_map ? *recipe.outputs.tone_map : environment.tone_map;
}

std::string canonical_model(const MeshHashes& mesh, MeshExtras reads,
                            const NormaliseOptions& options) {
  CanonicalText text;
  text.add("geometry", mesh.shape.hex());
  if (reads.uvs && mesh.uvs != Hash128{}) text.add("uvs", mesh.uvs.hex());
  if (reads.colors && mesh.colors != Hash128{}) text.add("colors", mesh.colors.hex());
  text.add("up", options.up == UpAxis::y ? "y" : "z");
  if (options.size_m != 0) text.add("size_m", options.size_m);
  if (options.place_on_ground) text.add("ground_z_m", options.ground_z_m);
  text.add("centre", name_of(options.centre));
  if (turns(options)) text.add("turn", std::span<const double>(options.turn));
  if (options.place_m != NormaliseOptions{}.place_m)
    text.add("place_m", std::span<const double>(options.place_m));
  if (!reads.normals) return text.text();
  text.add("normals", name_of(options.normals));
  if (options.normals == Normals::smooth) text.add("crease_deg", options.crease_deg);
  if (options.normals == Normals::keep) text.add("kept_normals", mesh.normals.hex());
  return text.text();
}

Hash128 render_key(const PartHashes& parts) {
  CanonicalText text;
  for (std::size_t i = 0; i < 5; ++i)
    text.add(k_part_names[i], parts[i].hex());
  return hash_text(text.text());
}

}  // namespace ds
