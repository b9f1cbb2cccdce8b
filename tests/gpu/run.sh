#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs this pack on an OpenCL device and prints a table of what is equal and how fast:
#   sh FOLDER/run [--device NAME] [--library FILE] [--seconds N] [--list] [CASE...]
# runner.c says what the options mean. All is written into a temporary folder, some 70 MB. It needs glibc 2.34, tar, gzip
# and an OpenCL driver, and on other machines than x86-64 a C compiler as well.
folder=$(cd "$(dirname "$0")" && pwd) || exit 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
tar -xzf "$folder/pack.tar.gz" -C "$work" || exit 2
# PoCL offers no device where it cannot write.
POCL_CACHE_DIR=${POCL_CACHE_DIR:-$work}
export POCL_CACHE_DIR
runner="$folder/runner"
if [ "$(uname -m)" != x86_64 ]; then
  runner="$work/runner"
  "${CC:-cc}" -std=c11 -O2 "$folder/runner.c" -o "$runner" -ldl ||
    { echo "run: runner.c could not be compiled" >&2; exit 2; }
fi
"$runner" "$work/pack" "$@"
