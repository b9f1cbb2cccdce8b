// SPDX-License-Identifier: Apache-2.0
// What the host asks of a plane: DS_TRAITS in its header names a sum of these. No program holds this
// file.
#pragma once

enum {
  // A plane reads ...
  k_plane_surface = 1,        ///< HitPoint::surface
  k_plane_normals = 2,        ///< ... its shading normal
  k_plane_uvs = 4,            ///< ... its u and v
  k_plane_objects = 8,        ///< HitPoint::object of others than the model
  k_plane_material_ids = 16,  ///< HitPoint::material_id
  k_plane_alone = 32,         ///< nothing but the model: the rest of the scene is not there
  k_plane_materials =
      4096,              ///< HitPoint::albedo: materials, textures and what of meshes these read
  k_plane_light = 8192,  ///< the picture's paths: contribution.h, not plane.h
  // Of light, it is ...
  k_plane_beside = 16384,    ///< none of those that add up to the picture
  k_plane_coverage = 32768,  ///< 1 for each sample whose ray meets something
  k_plane_cut_out = 65536,   ///< to be had as PNG with alpha, through the tone map
  // Its numbers are ...
  k_plane_words = 64,        ///< natural numbers, by their bits
  k_plane_exr = 128,         ///< to be had as EXR, of floats or halves
  k_plane_png_share = 256,   ///< as PNG: [0, 1] in the whole range
  k_plane_png_signed = 512,  ///< as PNG: [-1, 1] in the whole range
  k_plane_png_milli = 1024,  ///< as PNG: thousandths
  k_plane_png_words = 2048,  ///< as PNG: the number itself
};
