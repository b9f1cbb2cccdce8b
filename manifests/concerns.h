// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ds {

/// What makes a dataset less than it seems to be, though every file of it is as wanted.
///   mask_empty       images whose mask shows nothing of the model
///   mask_at_frame    images whose mask has a pixel in the first or last row or column
///   mask_small       images whose mask has some pixels, but under 1 % of all
///   picture_black    pictures of which under 1 in 1000 pixels has a channel above 4 of 255
///   picture_white    pictures of which over a quarter of the pixels are clipped in every channel
///   models_absent    models that the class files list and that have no file
///   models_unlisted  model files that no class file lists, where there is one
///   entries_ambiguous  entries of the class files that mean several model files each, as "mug" does
///                    mug.off and mug.ply
///   classes_unshared  classes that have models in one of the class files and none in the other
///   classes_empty    classes of the class files, and classes above them, that no image is of
///   assets_unphysical  material files and environments with a surface that gives back more light
///                    than it gets, or another value that no real surface has
///   assets_unlikely  material files and environments with something that is hardly meant: a thing that
///                    nothing uses, a property that stands twice, no light at all, a texture that
///                    reads what the mesh does not have
///   sizes_unlikely   images of lengths that hardly go together, as where one is in millimetres: the
///                    camera inside the model, the lens wider than it, ...
///   names_by_case    images whose name differs from another's in upper and lower case only: where a
///                    file system does not tell these apart, their files are one
///   meshes_damaged   model files, and environments with a mesh file, that lost faces when read
///   models_unlikely  models with colours, uvs or normals that images read and that are hardly what is
///                    meant
///   own_materials_partial  models shown in the materials of their files (materials.assign = "own") that
///                    have faces without one, or what of it is not shown
///   distractors_unplaced  images that show fewer distractors than were drawn: no more found a place, or there
///                    was no other model
///   draws_idle       keys whose distributions change nothing of any image
struct Concern {
  std::string name;
  std::uint64_t count = 0;            ///< 0: none
  std::uint64_t of = 0;               ///< images with a mask, pictures, models listed, ...
  std::vector<std::string> examples;  ///< the first few: ids of images, names

  bool operator==(const Concern&) const = default;
};

/// How many examples are kept of each.
inline constexpr std::size_t k_concern_examples = 3;

/// "mask_empty" and so on with counts of 0, in the order above.
std::vector<Concern> no_concerns();
/// One of them by its name, which must be in the list.
Concern& concern(std::vector<Concern>& concerns, const char* name);
/// Counts one more.
void add_example(Concern& concern, const std::string& example);

}  // namespace ds
