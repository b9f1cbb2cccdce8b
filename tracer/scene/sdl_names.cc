// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_names.h"

#include <algorithm>
#include <iterator>
#include <span>

namespace ds {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::string_view k_textures[] = {"imagemap",
                                           "constfloat1",
                                           "constfloat3",
                                           "scale",
                                           "add",
                                           "subtract",
                                           "divide",
                                           "mix",
                                           "checkerboard2d",
                                           "checkerboard3d",
                                           "fbm",
                                           "marble",
                                           "wrinkled",
                                           "windy",
                                           "dots",
                                           "brick",
                                           "band",
                                           "uv",
                                           "bilerp",
                                           "clamp",
                                           "abs",
                                           "colordepth",
                                           "normalmap",
                                           "hitpointcolor",
                                           "hitpointgrey",
                                           "hitpointalpha",
                                           "hitpointvertexaov",
                                           "hitpointtriangleaov",
                                           "blackbody",
                                           "irregulardata",
                                           "lampspectrum",
                                           "fresnelapproxn",
                                           "fresnelapproxk",
                                           "fresnelcolor",
                                           "fresnelconst",
                                           "fresnelpreset",
                                           "fresnelsopra",
                                           "fresnelluxpop",
                                           "fresnelcauchy",
                                           "fresnelabbe",
                                           "triplanar",
                                           "hsv",
                                           "brightcontrast",
                                           "remap",
                                           "power",
                                           "lessthan",
                                           "greaterthan",
                                           "dotproduct",
                                           "makefloat3",
                                           "splitfloat3",
                                           "objectid",
                                           "objectidcolor",
                                           "objectidnormalized",
                                           "position",
                                           "shadingnormal",
                                           "random",
                                           "wireframe",
                                           "distort",
                                           "bombing",
                                           "densitygrid",
                                           "cloud",
                                           "rounding",
                                           "modulo",
                                           "blender_blend",
                                           "blender_clouds",
                                           "blender_distortednoise",
                                           "blender_magic",
                                           "blender_marble",
                                           "blender_musgrave",
                                           "blender_noise",
                                           "blender_stucci",
                                           "blender_voronoi",
                                           "blender_wood"};
constexpr std::string_view k_materials[] = {"matte",
                                            "roughmatte",
                                            "mirror",
                                            "glass",
                                            "roughglass",
                                            "archglass",
                                            "mattetranslucent",
                                            "roughmattetranslucent",
                                            "glossy2",
                                            "glossycoating",
                                            "glossytranslucent",
                                            "metal2",
                                            "velvet",
                                            "cloth",
                                            "carpaint",
                                            "mix",
                                            "null",
                                            "twosided",
                                            "disney"};
constexpr std::string_view k_shapes[] = {"mesh",
                                         "inlinedmesh",
                                         "pointiness",
                                         "strands",
                                         "group",
                                         "subdiv",
                                         "displacement",
                                         "harlequin",
                                         "simplify",
                                         "islandaov",
                                         "randomtriangleaov",
                                         "edgedetectoraov",
                                         "bevel",
                                         "camerainvisible",
                                         "merge"};
constexpr std::string_view k_lights[] = {
    "point",      "mappoint", "sphere",       "mapsphere",        "spot",
    "projection", "laser",    "sharpdistant", "distant",          "sun",
    "sky2",       "sky",      "infinite",     "constantinfinite", "trianglelight"};
constexpr std::string_view k_film[] = {"TONEMAP_LINEAR",
                                       "TONEMAP_REINHARD02",
                                       "TONEMAP_AUTOLINEAR",
                                       "TONEMAP_LUXLINEAR",
                                       "TONEMAP_OPENCOLORIO",
                                       "GAMMA_CORRECTION",
                                       "NOP",
                                       "PREMULTIPLY_ALPHA",
                                       "OUTPUT_SWITCHER",
                                       "OBJECT_ID_MASK",
                                       "BACKGROUND_IMG",
                                       "CAMERA_RESPONSE_FUNC",
                                       "BLOOM",
                                       "VIGNETTING",
                                       "COLOR_ABERRATION",
                                       "GAUSSIANFILTER_3x3",
                                       "MIST",
                                       "CONTOUR_LINES",
                                       "PATTERNS",
                                       "WHITE_BALANCE",
                                       "COLOR_LUT",
                                       "BCD_DENOISER",
                                       "INTEL_OIDN",
                                       "OPTIX_DENOISER",
                                       "BAKEMAP_MARGIN"};

constexpr std::string_view k_texture_names[] = {"mapping", "randomizedtiling", "colorspace",
                                                "selectionmode"};
constexpr std::string_view k_material_names[] = {
    "transparency", "emission",   "bumptex",       "normaltex",  "bumpsamplingdistance",
    "id",           "visibility", "shadowcatcher", "holdout",    "volume",
    "photongi",     "cauchyb",    "cauchyc",       "filmamount", "filmthickness",
    "filmior"};
constexpr std::string_view k_shape_names[] = {"appliedtransformation", "colors", "alphas"};
constexpr std::string_view k_object_names[] = {"motion", "bakemap", "colors", "alphas"};
constexpr std::string_view k_light_names[] = {"volume",
                                              "mapfile",
                                              "iesfile",
                                              "iesblob",
                                              "map",
                                              "flipz",
                                              "visibility",
                                              "visibilitymap",
                                              "visibilitymapcache",
                                              "distribution",
                                              "id",
                                              "importance",
                                              "theta",
                                              "fov",
                                              "radius"};

Names types_of(SdlKind kind) {
  switch (kind) {
    case SdlKind::texture:
      return k_textures;
    case SdlKind::material:
      return k_materials;
    case SdlKind::shape:
      return k_shapes;
    case SdlKind::object:
      return {};
    case SdlKind::light:
      return k_lights;
    case SdlKind::film:
      return k_film;
  }
  return {};
}

Names property_names_of(SdlKind kind) {
  switch (kind) {
    case SdlKind::texture:
      return k_texture_names;
    case SdlKind::material:
      return k_material_names;
    case SdlKind::shape:
      return k_shape_names;
    case SdlKind::object:
      return k_object_names;
    case SdlKind::light:
      return k_light_names;
    case SdlKind::film:
      return {};
  }
  return {};
}

// "importance", "directlightsampling", "visibilitymapcache" and "distribution" choose how LuxCore
// samples, "id" of a light which output groups it is counted in, "photongi" and
// "bumpsamplingdistance" act with features that are refused.
constexpr NoEffect k_no_effect[] = {
    {SdlKind::texture, "randomizedtiling.enable", "0"},
    {SdlKind::material, "transparency.shadow", "0"},
    {SdlKind::material, "emission.importance", "*"},
    {SdlKind::material, "emission.id", "*"},
    {SdlKind::material, "emission.directlightsampling.type", "*"},
    {SdlKind::material, "emission.theta", "90"},
    {SdlKind::material, "bumpsamplingdistance", "*"},
    {SdlKind::material, "visibility.indirect.diffuse.enable", "1"},
    {SdlKind::material, "visibility.indirect.glossy.enable", "1"},
    {SdlKind::material, "visibility.indirect.specular.enable", "1"},
    {SdlKind::material, "shadowcatcher.enable", "0"},
    {SdlKind::material, "shadowcatcher.onlyinfinitelights", "0"},
    {SdlKind::material, "holdout.enable", "0"},
    {SdlKind::material, "photongi.enable", "*"},
    {SdlKind::shape, "appliedtransformation", "*"},
    {SdlKind::light, "id", "*"},
    {SdlKind::light, "importance", "*"},
    {SdlKind::light, "visibility.indirect.diffuse.enable", "1"},
    {SdlKind::light, "visibility.indirect.glossy.enable", "1"},
    {SdlKind::light, "visibility.indirect.specular.enable", "1"},
    {SdlKind::light, "visibilitymap", "*"},
    {SdlKind::light, "visibilitymapcache", "*"},
    {SdlKind::light, "distribution", "*"},
};

bool is_or_is_below(std::string_view name, std::string_view prefix) {
  return name == prefix ||
         (name.starts_with(prefix) && name.size() > prefix.size() && name[prefix.size()] == '.');
}

/// Whether a value as written means `wanted`: "0", "0.0", "false" and "0 0 0" are all "0".
bool means(const Property& property, std::string_view wanted) {
  const auto same = [&](const std::string& text) {
    if (text == wanted) return true;
    if (wanted == "1" && text == "true") return true;
    if (wanted == "0" && text == "false") return true;
    return text.starts_with(wanted) && text.size() > wanted.size() + 1 &&
           text[wanted.size()] == '.' &&
           text.find_first_not_of('0', wanted.size() + 1) == std::string::npos;
  };
  return std::all_of(property.values.begin(), property.values.end(), same);
}

bool contains(Names names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string_view section_of(SdlKind kind) {
  switch (kind) {
    case SdlKind::texture:
      return "scene.textures";
    case SdlKind::material:
      return "scene.materials";
    case SdlKind::shape:
      return "scene.shapes";
    case SdlKind::object:
      return "scene.objects";
    case SdlKind::light:
      return "scene.lights";
    case SdlKind::film:
      return "film.imagepipeline";
  }
  return "";
}

std::string_view word_for(SdlKind kind) {
  switch (kind) {
    case SdlKind::texture:
      return "texture";
    case SdlKind::material:
      return "material";
    case SdlKind::shape:
      return "shape";
    case SdlKind::object:
      return "object";
    case SdlKind::light:
      return "light";
    case SdlKind::film:
      return "image pipeline step";
  }
  return "";
}

bool luxcore_has_type(SdlKind kind, std::string_view type) {
  return contains(types_of(kind), type);
}

std::vector<NoEffect> no_effect_properties(SdlKind kind) {
  std::vector<NoEffect> found;
  std::copy_if(std::begin(k_no_effect), std::end(k_no_effect), std::back_inserter(found),
               [&](const NoEffect& entry) { return entry.kind == kind; });
  return found;
}

Leftover classify_leftover(SdlKind kind, std::string_view name, const Property& property) {
  for (const NoEffect& entry : k_no_effect)
    if (entry.kind == kind && is_or_is_below(name, entry.name) &&
        (entry.value == "*" || means(property, entry.value)))
      return Leftover::no_effect;
  return contains(property_names_of(kind), name.substr(0, name.find('.'))) ? Leftover::not_supported
                                                                           : Leftover::unknown;
}

}  // namespace ds
