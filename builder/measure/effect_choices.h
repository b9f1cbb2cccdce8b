// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/measure/choices.h"
#include "tracer/device/effects.h"

#include <string>
#include <vector>

namespace ds {

/// An effect that no choice leaves out.
struct KeptEffect {
  Effect effect;
  std::string why;  ///< "without it the scene is dark"
};

struct EffectChoices {
  std::vector<Choice> choices;
  std::vector<KeptEffect> kept;
};

/// Ways to leave out what the subject has, one thing at a time:
///   lens                a pinhole instead
///   light NAME          a light, or a material that emits, black
///   texture NAME        a texture that a material takes straight, as its mean over the surfaces
///   TYPE of NAME        a material that is not matte as a matte one: with its own `kd` where the
///                       type has that input, else with its albedo; a mix as its first part
///   hidden objects      what camera rays pass through is seen
///   smooth normals      every triangle flat
///   guide to caustics   paths leave by their BSDF alone: other noise
/// Each effect that effects_of says is simulated is left out whole by one of these, or by the least
/// set of them that does, as one more choice ("spot lights", "glossy2 materials"), or is kept for a
/// reason. Light is not taken from a scene that has no other. Nothing here names a material, a
/// texture or a kind of light but matte and mix: what the tables gain is covered.
EffectChoices effect_choices(const Subject& subject);

}  // namespace ds
