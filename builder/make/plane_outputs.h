// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/keys.h"
#include "builder/recipe/recipe.h"
#include "manifests/pixel_counts.h"
#include "tracer/render/render.h"

#include <cstddef>
#include <vector>

namespace ds {

/// What is traced where any plane that asks no light is to be made: all of these that are wanted, so
/// that a dataset has one program for them, and the mask, whose counts tell whether an image shows its
/// model.
std::vector<const PlaneType*> planes_of(const OutputSettings& outputs);
/// And where any plane of light is: all of these, and alpha for what is cut out by it.
std::vector<const PlaneType*> wanted_light_planes(const OutputSettings& outputs);
/// Of what planes_of traced, what goes with the file of a plane: with one of the model alone only what such
/// planes tell, since images in other surroundings share it.
PixelCounts count_planes(const std::vector<Plane>& planes, const PlaneType& of);
/// Whether the output is developed as the picture is: encode_cut_out makes it, and encode_output the others.
bool is_cut_out(const OutputSettings& outputs, const OutputFile& output);
/// `film`: the picture's, of the same samples.
std::vector<std::byte> encode_cut_out(const OutputFile& output, const std::vector<Plane>& planes,
                                      const Film& film, const ToneMap& tone_map);
/// The file of one of them.
std::vector<std::byte> encode_output(const OutputSettings& outputs, const OutputFile& output,
                                     const std::vector<Plane>& planes);

}  // namespace ds
