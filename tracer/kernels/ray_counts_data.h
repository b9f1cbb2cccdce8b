// SPDX-License-Identifier: Apache-2.0
// What a program built with -DDS_COUNT_RAYS counts (ray_counts.h).
#pragma once

enum { k_count_camera, k_count_extension, k_count_shadow, k_ray_counts };
