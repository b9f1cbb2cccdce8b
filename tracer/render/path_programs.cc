// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/path_programs.h"

#include "tracer/base/error.h"

#include <chrono>
#include <utility>

namespace ds {
namespace {

bool is_ready(const std::shared_future<Program>& program) {
  return program.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Whether it was compiled from its source; false while it is being made and where it failed.
bool was_compiled(const std::shared_future<Program>& program) {
  if (!is_ready(program)) return false;
  try {
    return !program.get().from_cache();
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

int default_lanes(const DeviceInfo& device) {
  if (!device.is_cpu) return 1;
  return device.float_lanes >= 16 ? 16 : 8;
}

PathPrograms::PathPrograms(const Device& device, std::string definitions,
                           std::filesystem::path cache_folder)
    : device_(device),
      definitions_(std::move(definitions)),
      cache_folder_(std::move(cache_folder)) {}

PathPrograms::Entry* PathPrograms::find(const SceneEffects& effects, MathMode math) {
  for (Entry& entry : entries_)
    if (entry.math == math && entry.effects == effects) return &entry;
  return nullptr;
}

std::shared_future<Program> PathPrograms::start(const SceneEffects& effects, MathMode math,
                                                std::launch when) {
  const std::string options = fmt::format(
      "{} {}", math == MathMode::strict ? k_strict_options : k_fast_options, definitions_);
  return std::async(when,
                    [this, effects, options] {
                      return device_.build(path_program_text(effects), options, cache_folder_);
                    })
      .share();
}

Program PathPrograms::get(const SceneEffects& effects, MathMode math) {
  Entry* entry = find(effects, math);
  if (entry == nullptr) {
    entries_.push_back({effects, math, false, start(effects, math, std::launch::deferred)});
    entry = &entries_.back();
  }
  return entry->program.get();
}

bool PathPrograms::make_ahead(const SceneEffects& effects, MathMode math) {
  if (find(effects, math) != nullptr) return false;
  entries_.push_back({effects, math, true, start(effects, math, std::launch::async)});
  return true;
}

ProgramCounts PathPrograms::counts() const {
  ProgramCounts counts;
  for (const Entry& entry : entries_) {
    ++counts.programs;
    counts.ahead += entry.ahead ? 1U : 0U;
    counts.compiled += was_compiled(entry.program) ? 1U : 0U;
  }
  return counts;
}

}  // namespace ds
