// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A plane that asks no light: of tracer/kernels/planes/NAME.h, which says what its numbers are.
struct PlaneType {
  std::string_view name;
  int width;        ///< numbers a pixel
  unsigned traits;  ///< sum of tracer/kernels/plane_traits.h
};

/// In the order of tracer/kernels/planes/list.h.
std::span<const PlaneType> plane_types();
/// Null where there is none of this name.
const PlaneType* find_plane(std::string_view name);
/// One that there is.
const PlaneType& plane_type(std::string_view name);

/// Source of the program that traces these planes, in this order.
std::string planes_program_text(std::span<const PlaneType* const> planes);

}  // namespace ds
