// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/number_range.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene.h"

#include <span>
#include <string>
#include <string_view>

namespace ds {

// DS_KERNELS: tests/precision compiles the kernels in double.
using DS_KERNELS::NodeOnHost;
using DS_KERNELS::Parameter;
using DS_KERNELS::ParameterKind;

/// What is outside of it is read, and warned of: [0, 1] of a share of light, else all there is.
inline NumberRange physical_range(const Parameter& parameter) {
  return parameter.kind == ParameterKind::share ? NumberRange{.least = 0, .most = 1}
                                                : NumberRange{};
}

/// What inputs of this name are within, whatever material or texture has them; shares of light in [0, 1].
NumberRange kept_range(std::string_view input);

/// An input that takes a constant or a texture. `width` is 1 (scalar) or 3 (colour).
struct InputType {
  std::string_view name;
  int width;
  float default_value;
  Parameter told{};  ///< what its header says of it
};

/// A number or switch that is fixed when the scene is read. A material's stand behind its inputs in
/// what its functions take.
struct NumberType {
  std::string_view name;
  float default_value;
  Parameter told{};  ///< what its header says of it
};

/// One kind of material or texture, made from the parameter list at the top of its kernel header
/// (tracer/kernels/materials/PREFIX.h, tracer/kernels/textures/PREFIX.h), so that both sides read
/// one text.
struct NodeType {
  std::string_view name;           ///< the SDL's `type`
  std::string_view kernel_prefix;  ///< of its kernel header and functions
  unsigned traits;                 ///< sum of tracer/kernels/traits.h
  int children;                    ///< materials it chooses among; k_most_children at most
  std::span<const InputType> inputs;
  std::span<const NumberType> numbers;
  NodeOnHost host{};
};

using DS_KERNELS::LightInput;
using DS_KERNELS::LightValue;

/// One kind of light: of tracer/kernels/lights/PREFIX.h, whose light.h tells what stands in it.
struct LightType {
  std::string_view name;  ///< the SDL's `type`; "" for emitting objects
  std::string_view kernel_prefix;
  unsigned traits;
  DS_KERNELS::LightOnHost host;
};

/// One kind of camera: of tracer/kernels/cameras/NAME.h.
struct CameraType {
  std::string_view name;  ///< the recipe's camera.type
  DS_KERNELS::CameraOnHost host;

  /// "fov_deg" or "extent_m": of the recipe's key, in keys and manifests.
  std::string_view span_name() const {
    return host.span == DS_KERNELS::CameraSpan::fov_deg ? "fov_deg" : "extent_m";
  }
};

/// Whether a type has one of these traits.
template <typename Type>
bool has_trait(const Type& type, unsigned traits) {
  return (type.traits & traits) != 0;
}
/// Whether a texture of this type reads uv, and whether it reads the mesh's colours.
bool reads_uvs(const NodeType& texture);
bool reads_colors(const NodeType& texture);

/// In the order of tracer/kernels/lists.h; Material::type and Texture::type index them.
std::span<const NodeType> material_types();
std::span<const NodeType> texture_types();
/// In that order too, for Light::type; those beyond the scene come last.
std::span<const LightType> light_types();
/// The row of a kernel prefix that there is.
const LightType& light_type(std::string_view prefix);
const LightType& type_of(const Light& light);
/// A light of this kernel prefix: black, all its values 0.
Light make_light(std::string_view prefix);
/// Where the values of an input stand that the light has, but its colour.
float* light_value(Light& light, std::string_view input);
const float* light_value(const Light& light, std::string_view input);
void set_light_value(Light& light, std::string_view input, Vec3 value);
Vec3 light_vector(const Light& light, std::string_view input);

/// In that order too, for Camera::type.
std::span<const CameraType> camera_types();
/// The row of a name, or -1.
int find_camera_type(std::string_view name);
const CameraType& type_of(const Camera& camera);
double& span_of(Camera& camera);
double span_of(const Camera& camera);
/// What the camera shows: half of the picture's width (x) and height (y), in its plane and more in
/// each metre before it.
struct ShownSides {
  double x_m = 0, y_m = 0, x_per_metre = 0, y_per_metre = 0;
};
ShownSides shown_by(const Camera& camera, int width, int height);

/// What a kernel header says first: the paragraph at its top, on one line. `folder` is "materials",
/// "textures", "lights", "cameras" or "planes".
std::string header_comment(std::string_view folder, std::string_view prefix);

/// Row of the type, or -1.
int find_type(std::span<const NodeType> types, std::string_view name);
/// Index of an input or number within its row, or -1.
int find_input(const NodeType& type, std::string_view name);
int find_number(const NodeType& type, std::string_view name);

}  // namespace ds
