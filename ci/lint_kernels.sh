#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Rules of strict arithmetic that no compiler checks: no built-in transcendental, no native_ or half_ function, no float
# atomic, no vector of three in kernel code; float literals carry an f.
set -euo pipefail
cd "$(dirname "$0")/.."

bad=0
# Comments may say what code may not, and the host's parts are in no program.
refuse() {
  local found
  found=$(for file in tracer/kernels/*.cl tracer/kernels/*.h tracer/kernels/*/*.h; do
    sed -e '/^#ifdef DS_HOOK_HOST$/,/^#endif$/s/.*//' -e 's|//.*||' "$file" | grep -nE "$1" | sed "s|^|$file:|" || true
  done)
  [ -z "$found" ] || { echo "$found"; echo "  kernel code must not use $2"; bad=1; }
}
refuse '\b(sin|cos|tan|asin|acos|atan|atan2|exp|exp2|log|log2|log10|pow|powr|rsqrt|cbrt|hypot|mad|sincos)\(' \
  'built-in transcendentals: other bits on other devices (math.h has its own)'
refuse '\b(native_|half_(sin|cos|exp|log|sqrt|powr|recip|divide))' 'functions of unstated precision'
refuse '\batomic' 'atomics: sums would depend on the order of threads'
refuse '\b(float|int|uint)3\b' 'three-component vectors: their size differs between languages'
refuse '[^a-zA-Z0-9_.][0-9]+\.[0-9]*(e[-+]?[0-9]+)?([^0-9a-zA-Z_.]|$)' 'double literals'
exit $bad
