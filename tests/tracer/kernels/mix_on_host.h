// SPDX-License-Identifier: Apache-2.0
// A mix as one BSDF of one lane, by the kernels' own resolve_choices: metal2 with a mix of matte and
// mirror. In namespace ds::DS_KERNELS.
#pragma once

#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/type_tables.h"

#include <array>
#include <bit>
#include <initializer_list>
#include <vector>

// The program's own numbers of materials, as device/program_text.cc writes them.
#define DS_MATERIALS(X) X(matte, 0) X(metal2, 1) X(mirror, 2)
#define DS_CHOOSERS(X) X(mix, 3)
#define DS_FIRST_CHOOSER 3
#define DS_MATERIAL_INPUTS 8
#define DS_CHOOSER_DEPTH 2

#if defined(__GNUC__)  // as all_nodes.h
#  pragma GCC diagnostic push
#  pragma GCC diagnostic ignored "-Wunused-parameter"
#  pragma GCC diagnostic ignored "-Wold-style-cast"
#  pragma GCC diagnostic ignored "-Wsign-conversion"
#endif
// clang-format off
namespace ds::DS_KERNELS {
#include "tracer/kernels/shade.h"
#include "tracer/kernels/albedo.h"
#include "tracer/kernels/first_lobe.h"
}  // namespace ds::DS_KERNELS
// clang-format on
#if defined(__GNUC__)
#  pragma GCC diagnostic pop
#endif

namespace ds::DS_KERNELS {

/// As one BSDF it derives nothing.
enum { mix_derived = 0 };
inline void mix_prepare(const real*, Viewer, real*) {}

/// Where metal2's, whose inputs are behind the two amounts, is right.
inline constexpr NodeOnHost mix_parts_on_host{.parameters = {},
                                              .albedo_error = metal2_on_host.albedo_error,
                                              .albedo_holds = [](const float* p, bool outside) {
                                                return metal2_albedo_holds(p + 2, outside);
                                              }};

/// Its inputs in the order that the functions below take them.
inline const NodeType& mix_type() {
  static const std::vector<InputType> inputs = [] {
    std::vector<InputType> all;
    for (const char* part : {"mix", "mix", "metal2", "matte", "mirror"}) {
      const int row = find_type(material_types(), part);
      const auto& own = material_types()[static_cast<std::size_t>(row)].inputs;
      all.insert(all.end(), own.begin(), own.end());
    }
    all[1].name = "inner_amount";
    return all;
  }();
  static const NodeType type{"mix", "mix", mix_traits, mix_children, inputs, {}, mix_parts_on_host};
  return type;
}

/// The rows of its five materials and where `choice` leads among them.
class MixOnHost {
 public:
  explicit MixOnHost(const real* p) : words_(5 * k_row, 0.0f) {
    row(k_metal, 1, p + 2, 8);
    row(k_matte, 0, p + 10, 3);
    row(k_mirror, 2, p + 13, 3);
    row(k_inner, 3, p + 1, 1, k_matte, k_mirror);
    row(k_outer, 3, p, 1, k_metal, k_inner);
  }

  MaterialPoint resolve(real* choice, Viewer viewer) {
    MaterialPoint m;
    Surface s{};
    resolve_choices({words_.data(), nullptr, nullptr, k_row}, natural{k_outer}, all_lanes(), &s,
                    choice, &m);
    prepare_material(&m, viewer);
    return m;
  }

  real3 albedo(Viewer viewer) const {
    Surface s{};
    s.outside = viewer.outside;
    return surface_albedo({words_.data(), nullptr, nullptr, k_row}, natural{k_outer}, all_lanes(),
                          &s);
  }

 private:
  static constexpr uint k_row = k_material_head + DS_MATERIAL_INPUTS;
  enum : uint { k_metal, k_matte, k_mirror, k_inner, k_outer };

  void row(uint place, uint type, const real* inputs, uint count, uint first = 0, uint second = 0) {
    float* words = &words_[place * k_row];
    words[k_material_type] = std::bit_cast<float>(type);
    words[k_material_child] = std::bit_cast<float>(first);
    words[k_material_child + 1] = std::bit_cast<float>(second);
    for (uint i = 0; i < count; ++i)
      words[k_material_head + i] = static_cast<float>(inputs[i]);
  }

  std::vector<float> words_;
};

/// Means over the choice: each part's answer by the part's share.
inline BsdfValue mix_evaluate(const real* p, Viewer viewer, real3 wi) {
  const real outer = clamp01(p[0]), inner = clamp01(p[1]);
  BsdfValue mean = no_value();
  MixOnHost mix(p);
  // The middle of each part's share of [0, 1), and the share: mirror, matte, metal2.
  for (const auto& [middle, share] : {std::array{outer * inner * 0.5f, outer * inner},
                                      std::array{outer * (1 + inner) * 0.5f, outer * (1 - inner)},
                                      std::array{(1 + outer) * 0.5f, 1 - outer}}) {
    if (share == 0) continue;
    real choice = middle;
    const MaterialPoint m = mix.resolve(&choice, viewer);
    const BsdfValue v = evaluate_material(&m, viewer, wi);
    mean.value = add_scaled(mean.value, v.value, share);
    mean.pdf += v.pdf * share;
  }
  return mean;
}

/// As mix_evaluate.
inline real3 mix_diffuse(const real* p, Viewer viewer, real3 wi) {
  const real share = clamp01(p[0]) * (1 - clamp01(p[1]));  // of matte
  return scale(matte_evaluate(p + 10, viewer, wi).value, share);
}

inline real3 mix_albedo(const real* p, Viewer viewer) {
  return MixOnHost(p).albedo(viewer);
}

/// Weight and pdf are those of the part that lobe.x led to, as in the tracer.
inline BsdfSample mix_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const MaterialPoint m = MixOnHost(p).resolve(&lobe.x, viewer);
  return sample_material(&m, viewer, u, lobe);
}

}  // namespace ds::DS_KERNELS
