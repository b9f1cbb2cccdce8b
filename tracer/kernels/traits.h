// SPDX-License-Identifier: Apache-2.0
// What the host asks of a kind of material, texture or light: DS_TRAITS in its header names a sum of
// these, or 0. No program holds this file: a new trait makes nothing stale.
#pragma once

#include "tracer/kernels/value_bounds.h"

enum {
  // A material ...
  k_trait_lobes = 1,              ///< picks one of several lobes: its paths draw a number for it
  k_trait_casts_caustics = 2,     ///< gathers light: photons leave it
  k_trait_receives_caustics = 4,  ///< looks for what was gathered: guide.h
  k_trait_transmits = 512,        ///< has a value below the surface: lights there are asked as well
  // A texture reads ...
  k_trait_uv = 8,          ///< the mesh's uv, by a 2D mapping
  k_trait_position = 16,   ///< a point in space, by a 3D mapping
  k_trait_colors = 32,     ///< the mesh's colours
  k_trait_chooses = 1024,  ///< nothing else: it is texture1 here and texture2 there
  // A light ...
  k_trait_beyond = 64,  ///< lies beyond the scene: paths that leave meet it (NAME_escape)
  k_trait_sampled =
      128,              ///< is chosen by next-event estimation; others, scattered rays find as well
  k_trait_small = 256,  ///< shines from few directions: what is gathered of it is small and bright
};

/// What a number of a material or texture is.
enum class ParameterKind {
  number,
  share,  ///< of light: with all of them in [0, 1] no more is sent on than comes; what is read beyond
          ///< that is warned of
  whole,
  flag,  ///< 0 or 1
};

/// Of an input or number of a material or texture, in the DS_HOOK_HOST part of its header: a row for
/// each input, then for each number, in their order. Tests draw all of them from their ranges.
struct Parameter {
  std::string_view name;
  std::string_view help;  ///< with its unit
  NumberRange range{};    ///< of constants; what a texture gives may be anything
  ParameterKind kind = ParameterKind::number;
};
inline constexpr NumberRange k_not_negative{.least = 0};
inline constexpr NumberRange k_zero_to_one{.least = 0, .most = 1};

/// NAME_on_host of a material or texture, in its DS_HOOK_HOST part.
struct NodeOnHost {
  std::span<const Parameter> parameters;
  /// Of a material, with all its shares at 1, whatever the rest: at most so much of what comes is lost.
  double most_lost = 1;
  /// How far NAME_albedo may be from the integral of the BSDF where `albedo_holds` (null: everywhere)
  /// says that it is meant to be right; elsewhere it is in [0, 1] only.
  double albedo_error = 1e-3;
  bool (*albedo_holds)(const float* inputs, bool outside) = nullptr;
  /// Of a texture's values, of what is known of its inputs'; null: nothing is known.
  std::optional<ValueBounds> (*bounds)(std::span<const std::optional<ValueBounds>> inputs,
                                       const float* numbers) = nullptr;
};

/// What of a light the host makes by a function in a file of its own.
enum {
  k_host_reads = 1,     ///< NAME_reading of scene/lights/NAME.cc: more than its inputs' properties
  k_host_tables = 2,    ///< pack_NAME of device/pack_NAME.cc: its row points into tables
  k_host_panorama = 4,  ///< Light::image, and how it is turned
};

/// What a scene says of a light. Light::values has all but the colour, one behind the other.
enum class LightValue {
  color,      ///< Light::color: the first input of each light
  point,      ///< 3: world, metres
  direction,  ///< 3: world, unit
  number,     ///< 1
};
struct LightInput {
  std::string_view name;
  LightValue value;
  /// Of the SDL's property of this name, which a transformation applies to; "" for what is none and
  /// is made from others by NAME_reading.
  std::string_view default_value = "";
  std::string_view help = "";
  NumberRange range{};

  constexpr int width() const { return value == LightValue::number ? 1 : 3; }
};

/// NAME_on_host, in the DS_HOOK_HOST part of a light's header. What its functions call inputs are the
/// inputs' numbers, one behind the other.
struct LightOnHost {
  std::span<const LightInput> inputs;
  unsigned made_by = 0;  ///< sum of k_host_*
  /// Share of next-event estimation among others, by power; null: never sampled. `luminance`: of
  /// its colour; `scene_radius`: half the diagonal of the scene, on whose disc falls what comes from
  /// infinity.
  double (*power)(double luminance, const float* inputs, double scene_radius) = nullptr;
  void (*row)(const float* inputs, float* row) = nullptr;  ///< null: its row is the inputs
};

/// Half of what the longer side of a camera's picture shows: so much in the camera's plane, and so
/// much more in each metre before it. Its rays through a pixel's middle start in that plane.
struct CameraShape {
  double at_camera_m = 0;
  double per_metre = 0;
};
/// The unit, and so the member of Camera, in which that is told.
enum class CameraSpan { fov_deg, extent_m };

/// NAME_on_host, in the DS_HOOK_HOST part of a camera's header.
struct CameraOnHost {
  CameraSpan span;
  std::string_view default_value, help;  ///< of the recipe's camera.fov_deg or camera.extent_m
  NumberRange range;
  CameraShape (*shape)(double span);
};
