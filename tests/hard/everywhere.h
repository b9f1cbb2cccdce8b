// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/render/pictures.h"

#include <functional>
#include <string>
#include <vector>

/// A hard case holds in strict and in fast arithmetic, with as many paths side by side as users get
/// and with one, in the program made for the scene and in the one of all effects.
namespace ds::hard {

struct Way {
  MathMode math = MathMode::strict;
  int lanes = 16;  ///< the most there are; what processors get by default is 16 or 8
  bool full_program = false;
  std::string name() const;
};

/// Four, in which each two of arithmetic, lanes and program meet in every pairing; all eight where
/// DSBUILD_TEST_WAYS is set.
std::vector<Way> ways();
/// Those with the program of all effects, which no scene makes the tests wait for: enough where a
/// case is about a scene of its own for every material.
std::vector<Way> full_program_ways();

/// Traces on a tracer that the process keeps for each way.
Film trace(const pictures::Picture& picture, const Way& way);

/// Traces the picture in every way and asks `check` of each film. Strict films must be equal to the
/// last bit; no film may hold what is not finite or negative, and no sample may be rejected.
void everywhere(const pictures::Picture& picture, const std::function<void(const Film&)>& check);

/// Mean over all pixels and channels of independent pictures, and its standard error.
pictures::Estimate estimate(const pictures::Picture& picture, const Way& way, int pictures,
                            std::uint64_t first_seed = 1);

/// Every material of the table but, where not asked for, those that let light through.
std::vector<std::string> materials(bool with_transparent);
/// A material of this type with the table's defaults, and its parts before it; its index. A mix is
/// one of metal2 with a mix of matte and mirror (as materials::all() of tests/tracer/kernels has
/// it).
int add_material(Scene& scene, std::string_view type);
/// Of its lobes.
void set_alpha(Scene& scene, int material, float alpha);
/// A mix of these two in equal shares; its index.
int add_mix(Scene& scene, int first, int second);

/// The mesh with its triangles dealt out to these materials in turn.
void add_patches(Scene& scene, const Mesh& mesh, const std::vector<int>& materials);
/// A material of every type that lets no light through, with nothing absorbed: white but for what
/// the fits of microfacet.h leave (multiple_scattering_test.cc). One program for all of them.
std::vector<int> add_white_materials(Scene& scene, float u_roughness, float v_roughness);

/// A small square picture that follows paths to any depth and plays no roulette before `roulette`.
pictures::Picture deep_picture(int pixels, int spp, int roulette = 1000);

/// Largest difference of any value from `expected`.
double worst_difference(const Film& film, double expected);
double mean_of(const Film& film);

}  // namespace ds::hard
