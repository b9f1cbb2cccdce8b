// SPDX-License-Identifier: Apache-2.0
// A surface's colour: what share of white light that comes straight down on it its material sends on,
// reflected or let through (NAME_albedo of bsdf.h). Neither lights nor the viewer's place are in it.
#pragma once

#include "tracer/kernels/shade.h"

/// `m` is of one type in all lanes that count.
DS_FN real3 albedo_of(const MaterialPoint* m, uint type, Viewer viewer) {
  real3 albedo = splat((real)(0.0f));
#define DS_ALBEDO(name, number) \
  if (type == (uint)number) albedo = name##_albedo(m->inputs, viewer);
  DS_MATERIALS(DS_ALBEDO)
  return albedo;
}

/// Of one material in the lanes `here`; of one that chooses among others, the mean by their shares.
DS_FN real3 material_albedo(MaterialTables t, uint material, mask here, const Surface* s) {
  Viewer viewer;
  viewer.wo = vec((real)(0.0f), (real)(0.0f), (real)(1.0f));
  viewer.outside = s->outside;
  real3 sum = splat((real)(0.0f));
  uint rows[DS_CHOOSER_DEPTH + 1];
  real shares[DS_CHOOSER_DEPTH + 1];
  rows[0] = material;
  shares[0] = (real)(1.0f);
  for (int left = 1; left > 0;) {
    --left;
    const uint row = rows[left];
    const real share = shares[left];
    MaterialPoint m;
    read_material(t, (natural)(row), here, s, &m);
    const uint type = as_uint(t.materials[row * t.material_words + (uint)k_material_type]);
#ifdef DS_CHOOSERS
    if (type >= (uint)DS_FIRST_CHOOSER) {
      real second = (real)(0.0f);
#  define DS_SECOND(name, number) \
    if (type == (uint)number) second = name##_second(m.inputs, s->outside);
      DS_CHOOSERS(DS_SECOND)
      const uint child = row * t.material_words + (uint)k_material_child;
      rows[left] = as_uint(t.materials[child]);
      shares[left] = share * (1.0f - second);
      rows[left + 1] = as_uint(t.materials[child + 1u]);
      shares[left + 1] = share * second;
      left += 2;
      continue;
    }
#endif
    prepare_material(&m, viewer);
    sum = add_scaled(sum, albedo_of(&m, type, viewer), share);
  }
  return sum;
}

DS_FN real3 surface_albedo(MaterialTables t, natural material, mask wanted, const Surface* s) {
  real3 albedo = splat((real)(0.0f));
  for (mask left = wanted; any_lane(left);) {
    const uint one = first_of(left, material);
    const mask here = left & (material == one);
    albedo = choose(here, material_albedo(t, one, here, s), albedo);
    left = left & !here;
  }
  return albedo;
}
