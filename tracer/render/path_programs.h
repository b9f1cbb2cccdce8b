// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/opencl.h"
#include "tracer/device/program_text.h"
#include "tracer/render/render.h"

#include <deque>
#include <filesystem>
#include <future>
#include <string>

namespace ds {

/// N, the paths that a work-item carries: on CPUs as many as their vectors have floats, but 8 at
/// least, so that there are some to go on with when others end; on GPUs 1. With twice as many on
/// an AVX2 machine pictures take 0.99 of the time, and programs 1.8 times as long to compile.
int default_lanes(const DeviceInfo& device);

/// The path-tracing programs of one device, one for each set of effects and kind of arithmetic.
/// Each is made once: when it is asked for, or before that in a thread of its own, so that it is
/// compiled while a picture is traced with another. Called from one thread.
class PathPrograms {
 public:
  /// The device must outlive this. `cache_folder`: as Device::build.
  /// `definitions`: build options that every program is given.
  PathPrograms(const Device& device, std::string definitions, std::filesystem::path cache_folder);

  /// Waits where it is being made. Throws what Device::build threw, each time it is asked for.
  Program get(const SceneEffects& effects, MathMode math);
  /// Starts to make it in a thread; false where it is there or on its way. Does not throw for what
  /// is wrong with the program: `get` does.
  bool make_ahead(const SceneEffects& effects, MathMode math);
  ProgramCounts counts() const;

 private:
  struct Entry {
    SceneEffects effects;
    MathMode math;
    bool ahead;
    std::shared_future<Program> program;
  };
  Entry* find(const SceneEffects& effects, MathMode math);
  std::shared_future<Program> start(const SceneEffects& effects, MathMode math, std::launch when);

  const Device& device_;
  std::string definitions_;
  std::filesystem::path cache_folder_;
  std::deque<Entry> entries_;  ///< as few as there are sets of effects: searched one by one
};

}  // namespace ds
