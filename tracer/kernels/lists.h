// SPDX-License-Identifier: Apache-2.0
// Every material, texture, light and camera there is, for the host: X(SDL name, kernel prefix, PREFIX
// in capitals), of lights X(SDL name, kernel prefix), of cameras X(name). A scene's program gets a
// list of those it uses; this file is in none, so a new line here makes no picture stale.
#pragma once

/// Those with a BSDF, and those that choose among other materials.
#define DS_SCATTERING_MATERIALS(X)        \
  X("matte", matte, MATTE)                \
  X("glossy2", glossy2, GLOSSY2)          \
  X("metal2", metal2, METAL2)             \
  X("mirror", mirror, MIRROR)             \
  X("glass", glass, GLASS)                \
  X("roughglass", roughglass, ROUGHGLASS) \
  X("velvet", velvet, VELVET)             \
  X("disney", disney, DISNEY)
#define DS_CHOOSING_MATERIALS(X) X("mix", mix, MIX)
#define DS_ALL_MATERIALS(X) DS_SCATTERING_MATERIALS(X) DS_CHOOSING_MATERIALS(X)

#define DS_ALL_TEXTURES(X)                            \
  X("imagemap", imagemap, IMAGEMAP)                   \
  X("checkerboard3d", checkerboard3d, CHECKERBOARD3D) \
  X("marble", marble, MARBLE)                         \
  X("fbm", fbm, FBM)                                  \
  X("checkerboard2d", checkerboard2d, CHECKERBOARD2D) \
  X("wrinkled", wrinkled, WRINKLED)                   \
  X("scale", scale, SCALE)                            \
  X("mix", mix_texture, MIX_TEXTURE)                  \
  X("add", add, ADD)                                  \
  X("subtract", subtract, SUBTRACT)                   \
  X("hitpointcolor", hitpointcolor, HITPOINTCOLOR)    \
  X("hitpointgrey", hitpointgrey, HITPOINTGREY)       \
  X("hitpointalpha", hitpointalpha, HITPOINTALPHA)

/// Those that no path meets, and those that lie beyond the scene, which paths that leave it meet.
#define DS_UNMET_LIGHTS(X)        \
  X("point", point)               \
  X("spot", spot)                 \
  X("sharpdistant", sharpdistant) \
  X("distant", distant)
#define DS_BEYOND_LIGHTS(X)                \
  X("constantinfinite", constant_infinite) \
  X("infinite", infinite)                  \
  X("sun", sun)
/// All that a file has under scene.lights; the first is what an object with an emitting material is.
#define DS_SCENE_LIGHTS(X) DS_UNMET_LIGHTS(X) DS_BEYOND_LIGHTS(X)
#define DS_ALL_LIGHTS(X) X("", mesh) DS_SCENE_LIGHTS(X)
/// Types of a file that become one of these: X(SDL name, kernel prefix of that); the SDL name is the
/// prefix of NAME_reading, too.
#define DS_MADE_LIGHTS(X) X(sky2, infinite)

#define DS_ALL_CAMERAS(X) \
  X(perspective)          \
  X(orthographic)
