// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ds {

/// tan of half the angle, degrees in (0, 180), from + - * / and sqrt alone: the same bits on every
/// machine.
double tan_half(double angle_deg);

}  // namespace ds
