// SPDX-License-Identifier: Apache-2.0
// Id of the object's material as its file gives it (scene.materials.NAME.id), of a mix its own; 0
// where nothing is hit or the material has none.
#pragma once

#include "tracer/kernels/plane.h"

enum { material_id_width = 1 };
DS_TRAITS(material_id, k_plane_material_ids | k_plane_words | k_plane_png_words);

DS_FN void material_id_at(const HitPoint* h, real* out) {
  out[0] = real_of(h->material_id);
}
