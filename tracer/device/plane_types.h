// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/program_text.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A plane of tracer/kernels/planes/NAME.h, which says what its numbers are.
struct PlaneType {
  std::string_view name;
  int width;        ///< numbers a pixel
  unsigned traits;  ///< sum of tracer/kernels/plane_traits.h
};

/// In the order of tracer/kernels/planes/list.h.
std::span<const PlaneType> plane_types();
/// Null where there is none of this name.
const PlaneType* find_plane(std::string_view name);
/// One that there is.
const PlaneType& plane_type(std::string_view name);

/// Whether it is a share of the picture, of its paths and samples; others ask no light and are traced
/// by one ray a pixel.
bool is_of_light(const PlaneType& plane);
/// Whether it is as if nothing but the model were there.
bool is_of_model_alone(const PlaneType& plane);
/// Whether the plane's numbers come from the materials of what is hit.
bool reads_materials(const PlaneType& plane);

/// `effects` with the program of the picture and these planes of light beside it.
SceneEffects with_light_planes(SceneEffects effects, std::span<const PlaneType* const> planes);

/// Source of the program that traces these planes, which ask no light, in this order. `effects`: of the scene, where
/// one of them reads materials.
std::string planes_program_text(std::span<const PlaneType* const> planes,
                                const SceneEffects& effects = {});

}  // namespace ds
