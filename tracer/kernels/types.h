// SPDX-License-Identifier: Apache-2.0
// Data that host and device share. Only 4-byte scalars: no layout can differ. Tables are arrays of
// 4-byte words, floats or the bits of an unsigned number; the constants below are word offsets.
#pragma once

#include "tracer/kernels/language.h"

/// Constants of a scene. Offsets count words in the buffer named.
typedef struct {
  uint light_count;
  uint first_escape_light;  ///< lights from here on are met by paths that leave the scene
  uint light_table;  ///< offset in tables: light_count cumulative selection probabilities, the last
                     ///< is 1
  /// Candidates for a vertex' shadow ray: light_count, one of each light, whose selection
  /// probabilities are then 1 or 0; or 1, of a light chosen by these.
  uint light_rounds;
  uint material_words;            ///< words a row of materials takes
  float tie_low[3], tie_high[3];  ///< where surfaces may tie (ties.cl); low above high: nowhere
} SceneData;

/// Constants of a picture: the camera and the engine settings.
typedef struct {
  float start[3];        ///< world, metres: where rays through the picture's middle start; see
                         ///< ray_start_m of tracer/render/view.h
  float start_right[3];  ///< how far from there those through the middle of its right edge do, ...
  float start_up[3];     ///< ... and of its upper edge
  float start_depth;     ///< metres before the camera, along forward
  float right[3];        ///< world vector of half the image plane's width at distance 1
  float up[3];           ///< world vector of half the image plane's height at distance 1
  float forward[3];      ///< unit, world
  float lens_right[3];   ///< unit right times lens radius, metres
  float lens_up[3];
  /// The lens as rays' starts show it; at start_depth 0 the lens itself.
  float start_lens_right[3];
  float start_lens_up[3];
  float focus_distance;  ///< along forward, metres
  uint width, height;
  uint tiles_x;        ///< tiles in a row of tiles
  float sample_limit;  ///< greatest component a sample may have; what is brighter is scaled down
  uint seed_low, seed_high;
  uint depth_total, depth_diffuse, depth_glossy, depth_specular;
  uint roulette_depth;
  float roulette_cap;
} ViewData;

#ifndef __OPENCL_VERSION__
static_assert(sizeof(SceneData) == 11 * 4 && sizeof(ViewData) == 44 * 4, "no padding");
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

  // A row of materials: a head, then the inputs.
  k_material_type = 0,
  k_material_program = 1,   ///< offset in programs of what evaluates textured inputs, or k_none
  k_material_child = 2,     ///< 2: rows of mix's materials
  k_material_emission = 4,  ///< 3: radiance
  k_material_head = 8,

  // A row of lights: a head, then what the kind needs.
  k_light_kind = 0,
  k_light_probability = 1,  ///< of being a candidate
  k_light_parameters = 2,
  k_light_words = 32,
};
#define k_none 0xffffffffu

/// The guide's table (guide.h): a head, a cell for each place of a cube row by row, then the cells'
/// lobes. A cell is the offset of its lobes, or 0.
enum {
  k_guide_side = 0,       ///< cells along an edge
  k_guide_origin = 1,     ///< 3: the cube's low corner, world, metres
  k_guide_per_metre = 4,  ///< cells
  k_guide_nowhere = 8,    ///< lobes of no weight
  k_guide_lobes = 4,      ///< of a cell
  k_guide_radius2 = 3,    ///< of a lobe: its sphere's centre, squared radius, and share
  k_guide_weight = 4,
  k_guide_lobe_words = 5,
  k_guide_cells = k_guide_nowhere + k_guide_lobes * k_guide_lobe_words,
};

/// Greatest component of a sample that can be added at all; above it counts as infinite.
#define k_sample_most 1e30f

/// What a program built with -DDS_COUNT_RAYS counts (ray_counts.h).
enum { k_count_camera, k_count_extension, k_count_shadow, k_ray_counts };

/// Pixels that samples are added to together: squares of 4x4.
enum { k_tile_side = 4, k_tile_pixels = 16 };

/// A film is a row of tiles, a tile k_film_planes rows of one float for each of its pixels; those
/// outside the picture stay zero. First come the sums of the four quarters of a pixel, the upper
/// left one, the upper right one, the lower left one and the lower right one, each of them:
enum {
  k_film_sum = 0,            ///< 3: r, g, b
  k_film_compensation = 3,   ///< 3: what rounding has cut off (add_compensated of math.h)
  k_film_halves = 6,         ///< 3: even samples minus odd ones: two independent halves
  k_film_count = 9,          ///< samples
  k_film_count_halves = 10,  ///< even ones minus odd ones
  k_film_quarter = 11,
};
/// Then what is seldom other than zero, of the whole pixel.
enum {
  k_film_nan = 4 * k_film_quarter,  ///< samples not added because a component was not a number, ...
  k_film_infinite,                  ///< ... was infinite or above k_sample_most, ...
  k_film_negative,                  ///< ... was negative; each sample has the first kind that fits
  k_film_outliers,                  ///< samples scaled down to ViewData::sample_limit
  k_film_removed,                   ///< luminance that this took from them
  k_film_planes,
};

/// What a launch traces: how many pixels a work-item takes, and how many steps follow; then for
/// each step its tile's number, row by row, and the numbers of the first sample of the tile's
/// pixels and of the one behind the last.
enum { k_launch_share = 0, k_launch_steps = 1, k_launch_words = 2 };
enum { k_step_tile = 0, k_step_begin = 1, k_step_end = 2, k_step_words = 3 };
