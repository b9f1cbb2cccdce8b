// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/plan/output_kinds.h"
#include "builder/plan/text_form.h"
#include "tracer/device/plane_types.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/vary.h"

#include <map>
#include <string>
#include <string_view>

namespace ds {

/// What all images share of a plane that is wanted.
struct WantedPlane {
  const PlaneType* type = nullptr;
  Hash128 program;   ///< of its tokens, with this plane alone; none where plane_program has it
  MeshExtras reads;  ///< beside what materials read, where these are
  TextForm output;   ///< output_form
};
WantedPlane wanted_plane(const OutputKind& kind);

/// What the key of an output is the hash of, less what it is made from ("from").
TextForm output_form(std::string_view kind, std::string_view format,
                     const std::string& development);

/// Canonical text of what a plane that asks no light is traced from, but for what differs between models and materials:
/// the plane's program, the hash of the model, and of canonical_colours of its material, where it
/// reads materials; else the hash of the model and the material's id.
/// `shapes`: EnvironmentFacts::shapes. `change`: change_of it. `others`: canonical,
/// of what else is seen.
TextForm plane_form(const WantedPlane& plane, const std::map<unsigned, std::string>& shapes,
                    const ImageSpec& image, const EnvironmentChange& change,
                    const std::string& others = "");

/// Hash of the tokens of the program that traces this plane alone (with alpha, what is cut out by it) in the image's scene, of which the
/// question `of` says all that the program depends on.
Hash128 plane_program(const PlaneType& plane, const std::string& of, const Recipe& recipe,
                      Inputs& inputs, const ImageSpec& image);

}  // namespace ds
