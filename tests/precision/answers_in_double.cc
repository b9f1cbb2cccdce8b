// SPDX-License-Identifier: Apache-2.0
// The kernels in double.
#define DS_REAL_DOUBLE
#define DS_LENS
#define DS_AUDIT in_double
#include "tests/precision/answers.h"
