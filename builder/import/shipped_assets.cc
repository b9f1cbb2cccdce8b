// SPDX-License-Identifier: Apache-2.0
#include "builder/import/import.h"
#include "tracer/base/error.h"

#include <system_error>

namespace ds {

namespace fs = std::filesystem;

fs::path shipped_assets() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path places[] = {program / "assets", program.parent_path() / "share/dsbuild/assets",
                             program.parent_path().parent_path() / "assets"};
  for (const fs::path& place : places)
    if (fs::is_directory(place / "materials", error) &&
        fs::is_directory(place / "environments", error))
      return place;
  fail(ErrorKind::io,
       "the materials and environments that come with dsbuild are not there: looked for {}, {} and "
       "{}",
       places[0].string(), places[1].string(), places[2].string());
}

}  // namespace ds
