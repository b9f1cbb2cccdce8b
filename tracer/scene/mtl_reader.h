// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/own_materials.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

// Wavefront's MTL ("Advanced Visualizer Manual", appendix B; the properties of physically based surfaces as Blender and
// tinyobjloader have them). A line is a word and its values; "#" begins a comment. Words are read in any case.
//
//   "newmtl" NAME            begins a material; of two of one name the later counts
//   "Kd" R [G B]             colour, linear, as Blender reads it
//   "Ks" R [G B]             their mean is disney's `specular`, as Blender writes it: 0.5 is the 4 % of glTF
//   "Ns" EXPONENT            Blinn and Phong's; disney's roughness is that of GGX's alpha = sqrt(2 / (Ns + 2))
//                            (Walter et al. 2007, "Microfacet Models for Refraction", section 5.2), which is its square
//   "Pr" R, "Pm" R           disney's roughness and metallic; Pr goes before Ns
//   "illum" N                0 and 1: no highlight; 4 and above 5 with "d", "Tr": transparent
//   "map_Kd", "map_Pr", "map_Pm" {OPTION} FILE        multiplies Kd; stands for Pr, Pm where they are not given
//   OPTION = "-s" U [V [W]] | "-o" U [V [W]] | "-clamp" ("on" | "off") | "-imfchan" ("r" | "g" | "b" | "m" | "l" | "z")
//
// map_Kd's whole numbers are sRGB, others' as they stand. The texture's place is s uv + o, v up. FILE is all that is left
// of the line, blanks and all, relative to the .mtl; "\" in it is "/", and an absolute one that is not there is looked
// for beside the .mtl. Without Ks and Ns there is no highlight, but where Pr or Pm, or maps of them, stand: 4 %. Without
// Pr and Ns the roughness is 0.5.
namespace ds {

/// The files that lines "mtllib" of an OBJ file name: a line holds several, each up to a word that ends in ".mtl".
std::vector<std::filesystem::path> mtl_files(const std::vector<std::string>& lines,
                                             const std::string& obj);

/// The named ones of what the files define, in this order. Throws Error(asset) for a file that is not there or no text.
OwnMaterials mtl_materials(const std::vector<std::filesystem::path>& files,
                           const std::vector<std::string>& names);

struct MtlMaterial {
  OwnMaterial material;
  std::map<std::string, std::filesystem::path> images;  ///< by its inputs
  std::map<std::string, std::uint64_t> notes;           ///< of k_own_notes
};
struct MtlDefinitions {
  std::map<std::string, MtlMaterial> materials;
  std::map<std::string, std::uint64_t> notes;  ///< of no material
};
/// Adds what a file's text defines; `file` is its path, whether there is one or not. Throws Error(asset).
void parse_mtl(std::string_view text, const std::filesystem::path& file, MtlDefinitions& into);

}  // namespace ds
