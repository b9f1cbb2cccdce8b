// SPDX-License-Identifier: Apache-2.0
// A material's inputs followed by what it derives from them, as its functions take them. C++ only.
#pragma once

#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/lists.h"

#include <vector>

namespace ds::DS_KERNELS {

#define DS_FITS(sdl_name, prefix, PREFIX) \
  static_assert(int{prefix##_derived} <= int{k_most_derived});
DS_SCATTERING_MATERIALS(DS_FITS)
#undef DS_FITS

/// Must outlive what is done with `data`.
class Prepared {
 public:
  /// `count` inputs, then `derived` numbers by `prepare`; without any, `p` itself.
  Prepared(const real* p, int count, int derived, void (*prepare)(const real*, Viewer, real*),
           Viewer viewer)
      : p_(p) {
    if (derived == 0) return;
    numbers_.assign(p, p + count);
    numbers_.resize(static_cast<std::size_t>(count + derived));
    prepare(p, viewer, numbers_.data() + count);
    p_ = numbers_.data();
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  const real* data() const { return p_; }

 private:
  std::vector<real> numbers_;
  const real* p_;
};

}  // namespace ds::DS_KERNELS

/// The first argument of `prefix`_evaluate and `prefix`_sample for the inputs `p`, until the end of
/// the expression. Where ds::DS_KERNELS is in use.
#define DS_PREPARED(prefix, p, viewer) \
  Prepared(p, prefix##_end, prefix##_derived, prefix##_prepare, viewer).data()
