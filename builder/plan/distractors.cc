// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/distractors.h"

#include "builder/plan/environment_facts.h"
#include "builder/plan/image_material.h"
#include "builder/plan/keys.h"
#include "tracer/base/canonical.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace ds {
namespace {

double lowest_as_placed(Inputs& inputs, const std::filesystem::path& file,
                        const NormaliseOptions& options) {
  return tilts(options) && options.place_on_ground ? inputs.model_lowest(file, options) : 0;
}

Cylinder cylinder_around(const MeshExtent& file, const NormaliseOptions& options, double lowest) {
  const Mat4 to_world = model_to_world(file, options, lowest);
  const Box& box = file.box;
  // Moved and turned, a box's middle stays its middle.
  const Vec3d middle =
      to_world.point({(box.least.x + box.most.x) / 2, (box.least.y + box.most.y) / 2,
                      (box.least.z + box.most.z) / 2});
  Cylinder around{middle.x, middle.y, 0, middle.z, middle.z};
  double squared = 0;
  for (const double x : {box.least.x, box.most.x})
    for (const double y : {box.least.y, box.most.y})
      for (const double z : {box.least.z, box.most.z}) {
        const Vec3d p = to_world.point({x, y, z});
        const double dx = p.x - middle.x, dy = p.y - middle.y;
        squared = std::max(squared, dx * dx + dy * dy);
        around.low = std::min(around.low, p.z);
        around.high = std::max(around.high, p.z);
      }
  around.radius = std::sqrt(squared);
  return around;
}

bool holds(const Cylinder& cylinder, Vec3d p, double gap) {
  return p.z > cylinder.low - gap && p.z < cylinder.high + gap &&
         touch(cylinder, {p.x, p.y, 0, p.z, p.z}, gap);
}

/// Canonical entries with a distractor's name before each.
void add_prefixed(CanonicalText& text, int number, const std::string& entries) {
  for (const auto& [name, value] : parse_canonical(entries))
    text.add(distractor_key(number, name), value);
}

}  // namespace

bool touch(const Cylinder& a, const Cylinder& b, double gap) {
  const double dx = a.x - b.x, dy = a.y - b.y, apart = a.radius + b.radius + gap;
  return dx * dx + dy * dy < apart * apart;
}

std::string distractor_name(const Distractor& distractor) {
  return fmt::format("distractors[{}]", distractor.number);
}

const Scene& material_file_of(const Distractor& distractor, Inputs& inputs) {
  return distractor.material_file.is_same(distractor.model.file)
             ? inputs.own_material(distractor.model.file)
             : inputs.material(*distractor.material_file);
}

void place_distractors(ImageSpec& image, const Recipe& recipe, Inputs& inputs) {
  image.unplaced = 0;
  if (recipe.distractors.models.empty()) return;
  std::vector<Distractor> drawn =
      draw_distractors(image, recipe, [&](const DistractorModel& model) {
        return inputs.model_hashes(model.file).shape == inputs.model_hashes(image.model_file).shape;
      });
  const auto count = static_cast<int>(image.variables->values.distractor_count);
  const double gap = recipe.distractors.gap_m;
  std::vector<Cylinder> taken{cylinder_around(inputs.model_extent(image.model_file),
                                              normalise_of(image, recipe), image.lowest)};
  std::vector<Distractor> placed;
  for (Distractor& one : drawn) {
    const MeshExtent& extent = inputs.model_extent(one.model.file);
    one.lowest = lowest_as_placed(inputs, one.model.file, normalise_of(one, recipe));
    for (int tries = 0; tries < recipe.distractors.tries; ++tries) {
      draw_place(one, image, recipe, tries);
      const Cylinder own = cylinder_around(extent, normalise_of(one, recipe), one.lowest);
      if (holds(own, image.camera.position, gap) ||
          std::any_of(taken.begin(), taken.end(),
                      [&](const Cylinder& other) { return touch(own, other, gap); }))
        continue;
      taken.push_back(own);
      placed.push_back(std::move(one));
      break;
    }
  }
  image.unplaced = count - static_cast<int>(placed.size());
  image.distractors = std::move(placed);
}

const DistractorTexts::Facts& DistractorTexts::facts_of(const Distractor& distractor) {
  const auto [at, is_new] = facts_.try_emplace(distractor.material_file->native());
  Facts& facts = at->second;
  if (!is_new) return facts;
  try {
    // What constants stand in place of others is no matter for all but the first two.
    const Scene material = material_of(distractor, recipe_, inputs_);
    facts.material = hash_text(canonical_material(material)).hex();
    facts.colours = hash_text(canonical_colours(material)).hex();
    facts.ids = ids_of_model(material);
    facts.program = program_share_of(material).hex();
    facts.reads = reads_of_model(material);
    facts.reads.normals = true;
  } catch (...) {
    facts_.erase(at);
    throw;
  }
  return facts;
}

std::string DistractorTexts::material_of_own(const Distractor& distractor) {
  if (recipe_.distractors.vary.empty()) return facts_of(distractor).material;
  return hash_text(canonical_material(material_of(distractor, recipe_, inputs_))).hex();
}

std::string DistractorTexts::colours_of_own(const Distractor& distractor) {
  if (recipe_.distractors.vary.empty()) return facts_of(distractor).colours;
  return hash_text(canonical_colours(material_of(distractor, recipe_, inputs_))).hex();
}

std::string DistractorTexts::of_picture(const ImageSpec& image) {
  CanonicalText text;
  for (const Distractor& one : *image.distractors) {
    const Facts& facts = facts_of(one);
    add_prefixed(text, one.number,
                 canonical_model(inputs_.model_hashes(one.model.file), facts.reads,
                                 normalise_of(one, recipe_)));
    text.add(distractor_key(one.number, "material"), material_of_own(one));
  }
  return text.text();
}

std::string DistractorTexts::of_plane(const ImageSpec& image, const PlaneType& plane) {
  const bool colours = reads_materials(plane);
  CanonicalText text;
  for (const Distractor& one : *image.distractors) {
    MeshExtras reads{(plane.traits & kernels::k_plane_uvs) != 0, false,
                     (plane.traits & kernels::k_plane_normals) != 0};
    if (colours) {
      reads = facts_of(one).reads;
      reads.normals = (plane.traits & kernels::k_plane_normals) != 0;
    }
    add_prefixed(
        text, one.number,
        canonical_model(inputs_.model_hashes(one.model.file), reads, normalise_of(one, recipe_)));
    text.add(distractor_key(one.number, "id"), one.id());
    if ((plane.traits & kernels::k_plane_material_ids) != 0)
      text.add(distractor_key(one.number, "material_id"), facts_of(one).ids);
    if (colours) text.add(distractor_key(one.number, "material"), colours_of_own(one));
  }
  return text.text();
}

std::string DistractorTexts::programs(const ImageSpec& image) {
  std::set<std::string> shares;
  for (const Distractor& one : *image.distractors)
    shares.insert(facts_of(one).program);
  return fmt::format("{}", fmt::join(shares, " "));
}

}  // namespace ds
