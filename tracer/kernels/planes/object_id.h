// SPDX-License-Identifier: Apache-2.0
// Id of the object: 1 is the model, those of distractors begin with 101, others are as the environment gives them
// (scene.objects.NAME.id); 0 where nothing is hit or the object has none.
#pragma once

#include "tracer/kernels/plane.h"

enum { object_id_width = 1 };
DS_TRAITS(object_id, k_plane_objects | k_plane_words | k_plane_png_words);

DS_FN void object_id_at(const HitPoint* h, real* out) {
  out[0] = real_of(h->object);
}
