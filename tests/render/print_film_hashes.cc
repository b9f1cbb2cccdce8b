// SPDX-License-Identifier: Apache-2.0
// Prints the hash of every picture of all_effects, a line each, for a test that runs this program
// in another environment.
#include "tests/render/pictures.h"
#include "tracer/base/error.h"

#include <cstdio>

int main() {
  try {
    for (const ds::pictures::Picture& picture : ds::pictures::all_effects())
      std::printf("%s\n", ds::pictures::film_hash(ds::pictures::trace(picture)).c_str());
  } catch (const ds::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
