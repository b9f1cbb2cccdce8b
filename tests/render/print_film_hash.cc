// SPDX-License-Identifier: Apache-2.0
// Prints the hash of the last picture of all_effects, for a test that runs this program in another
// environment.
#include "tests/render/pictures.h"
#include "tracer/base/error.h"

#include <cstdio>

int main() {
  try {
    const ds::Film film = ds::pictures::trace(ds::pictures::all_effects().back());
    std::printf("%s\n", ds::pictures::film_hash(film).c_str());
  } catch (const ds::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
