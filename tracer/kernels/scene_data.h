// SPDX-License-Identifier: Apache-2.0
// The packed scene that host and device share. Only 4-byte scalars: no layout can differ. Tables are
// arrays of 4-byte words, floats or the bits of an unsigned number; the constants below are word
// offsets.
#pragma once

#include "tracer/kernels/language.h"

/// Of SceneData::tie_low and tie_high.
#define k_most_tie_places 8

/// Constants of a scene. Offsets count words in the buffer named.
typedef struct {
  uint light_count;
  uint first_escape_light;  ///< lights from here on are met by paths that leave the scene
  uint light_table;  ///< offset in tables: light_count cumulative selection probabilities, the last
                     ///< is 1
  /// Candidates for a vertex' shadow ray: light_count, one of each light, whose selection
  /// probabilities are then 1 or 0; or 1, of a light chosen by these.
  uint light_rounds;
  uint material_words;  ///< words a row of materials takes
  /// Boxes where surfaces may tie (ties.cl); nowhere else.
  uint tie_places;
  float tie_low[k_most_tie_places][3], tie_high[k_most_tie_places][3];
} SceneData;

#ifndef __OPENCL_VERSION__
static_assert(sizeof(SceneData) == 54 * 4, "no padding");
#endif

enum {
  k_most_rounds = 8,  ///< of SceneData::light_rounds
  k_bvh_width = 8,
  k_bvh_depth = 32,  ///< levels of nodes; the builder refuses a deeper tree
  k_bvh_stack = (k_bvh_width - 1) * k_bvh_depth + 1,

  // A node of the tree: eight vectors of eight floats. Bounds of child i stand in element i of
  // x_low, x_high, ...; vector 6 holds the references: a node's index, or a leaf's with the top bit
  // set. Absent children are inside out.
  k_node_vectors = 8,
  k_node_children = 6,
  k_root_bounds = 7,  ///< of the root: the scene's bounds, low x y z, high x y z
  // A leaf: corners p0.x, p0.y, p0.z, p1.x, ... p2.z of eight triangles, then their ids. Absent
  // ones are all zero.
  k_leaf_vectors = 10,
  k_leaf_ids = 9,

  // A triangle's row in `triangles`.
  k_triangle_positions = 0,  ///< 9
  k_triangle_normals = 9,    ///< 9, unit, on the triangle's own side
  k_triangle_uvs = 18,       ///< 6
  k_triangle_material = 24,  ///< row of materials
  k_triangle_light = 25,     ///< row of lights, or k_none
  k_triangle_object = 26,    ///< object id
  k_triangle_flags = 27,     ///< k_flag_*
  k_triangle_words = 28,
  k_flag_camera_invisible = 1,
  // Of a triangle that ties with others (ties.cl):
  k_flag_covered = 2,      ///< one of lesser rank lies in its plane
  k_flag_covers = 4,       ///< one of greater rank does
  k_flag_tie_rounded = 8,  ///< and not just in the same plane across an axis
  k_flags_tied = k_flag_covered | k_flag_covers,
  k_tie_error_shift = 8,  ///< 8 bits: exponent of the float that bounds the position_error of all
                          ///< that tie with it
  k_tie_rank_shift = 16,  ///< 16 bits: its object's rank; the least lies on top
  k_most_tie_rank = 0xffff,

  // A row of colours in `tables`: red, green, blue and alpha of a triangle's three corners. The
  // first row is white, then comes one for each triangle.
  k_color_words = 12,

  // A row of materials: a head, then the inputs and the numbers.
  k_material_type = 0,
  k_material_program = 1,  ///< offset in programs of what evaluates textured inputs, or k_none
  k_material_child = 2,    ///< 2: rows of the materials it chooses among
  k_most_children = 2,
  k_material_emission = 4,  ///< 3: radiance
  k_material_head = 8,

  // A row of lights: a head, then what the kind needs.
  k_light_kind = 0,
  k_light_probability = 1,  ///< of being a candidate
  k_light_parameters = 2,
  k_light_words = 32,
};
#define k_none 0xffffffffu
