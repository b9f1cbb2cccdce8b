// SPDX-License-Identifier: Apache-2.0
// Every plane, for the host: X(name). A program gets those it is asked for; this file is in none, so
// a new line here makes no plane stale.
#pragma once

#define DS_ALL_PLANES(X) \
  X(mask)                \
  X(amodal_mask)         \
  X(depth)               \
  X(distance)            \
  X(position)            \
  X(geometry_normal)     \
  X(shading_normal)      \
  X(uv)                  \
  X(object_id)           \
  X(material_id)         \
  X(albedo)              \
  X(emission)            \
  X(direct_diffuse)      \
  X(direct_glossy)       \
  X(indirect_diffuse)    \
  X(indirect_glossy)     \
  X(indirect_specular)   \
  X(alpha)               \
  X(foreground)
