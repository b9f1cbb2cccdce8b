// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/clean.h"

#include "builder/cmd/plan_text.h"
#include "builder/cmd/slurm_state.h"
#include "builder/cmd/verbs.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/streams.h"

namespace ds {

int run_clean(const Arguments& arguments) {
  RealDisk disk;
  const Access access = arguments.dry_run ? Access::look : Access::build;
  std::error_code error;
  if (const std::filesystem::path folder = dataset_folder(arguments.request());
      !std::filesystem::exists(folder / ".dsbuild", error))
    fail(ErrorKind::usage, "{}: nothing was built there", folder.string());
  DatasetRequest request = arguments.request();
  request.check_filled = [](const SlurmMark& mark) { refuse_filled_store(mark, "clean"); };
  Dataset dataset = open_dataset(request, access, disk);
  const CleanResult result = clean_dataset(dataset, disk, arguments.dry_run);
  nlohmann::json edited = nlohmann::json::array();
  for (const std::filesystem::path& file : result.edited)
    edited.push_back(file.lexically_relative(dataset.folder).generic_string());
  if (!result.edited.empty())
    warn(fmt::format(
        "{}{}: left, since no build wrote what {} now", result.edited.front().string(),
        result.edited.size() == 1 ? "" : fmt::format(" and {} more", result.edited.size() - 1),
        result.edited.size() == 1 ? "it holds" : "they hold"));
  if (arguments.json)
    print_json({{"files", result.files},
                {"bytes", result.bytes},
                {"edited", edited},
                {"dry_run", arguments.dry_run}});
  else
    say(Stream::report, "{}: {} file{} {}, {:.1f} MB\n", dataset.folder.string(), result.files,
        result.files == 1 ? "" : "s", arguments.dry_run ? "would be removed" : "removed",
        static_cast<double>(result.bytes) / 1e6);
  return 0;
}

}  // namespace ds
