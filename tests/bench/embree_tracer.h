// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/bench/ray_scene.h"

#include <cstddef>
#include <functional>
#include <vector>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace ds {

/// Embree's side: work in chunks dealt out to as many threads as the machine has.
class EmbreeTracer {
 public:
  explicit EmbreeTracer(const std::vector<Corners>& triangles);
  ~EmbreeTracer();
  EmbreeTracer(const EmbreeTracer&) = delete;
  EmbreeTracer& operator=(const EmbreeTracer&) = delete;

  static unsigned threads();

  /// One rtcIntersect1 a ray.
  void trace(const std::vector<RayWords>& rays, std::vector<Met>& met) const;

  /// The same for rays that are made as they are needed: `make(i)` gives ray i of `count`, `take(i, met)`
  /// gets what it met. Both are called from all threads.
  template <typename MakeRay, typename Take>
  void trace_each(std::size_t count, const MakeRay& make, const Take& take) const {
    in_chunks(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        take(i, trace_one(make(i)));
    });
  }
  /// And by rtcIntersect16, sixteen rays that follow each other at once; `count` is a multiple of 16.
  template <typename MakeRay, typename Take>
  void trace_packets(std::size_t count, const MakeRay& make, const Take& take) const {
    in_chunks(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; i += k_packet) {
        std::array<RayWords, k_packet> rays;
        for (std::size_t k = 0; k < k_packet; ++k)
          rays[k] = make(i + k);
        const std::array<Met, k_packet> met = trace_packet(rays);
        for (std::size_t k = 0; k < k_packet; ++k)
          take(i + k, met[k]);
      }
    });
  }

 private:
  static constexpr std::size_t k_packet = 16;
  static void in_chunks(std::size_t count,
                        const std::function<void(std::size_t begin, std::size_t end)>& work);
  Met trace_one(const RayWords& ray) const;
  std::array<Met, k_packet> trace_packet(const std::array<RayWords, k_packet>& rays) const;

  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;
};

}  // namespace ds
