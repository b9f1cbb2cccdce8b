// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/embree_tracer.h"

#include "tracer/base/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

#if defined(__SSE__)
#  include <pmmintrin.h>
#  include <xmmintrin.h>
#endif

namespace ds {
namespace {

/// As Embree's manual asks for its full speed.
void flush_denormals() {
#if defined(__SSE__)
  _mm_setcsr(_mm_getcsr() | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
#endif
}

}  // namespace

EmbreeTracer::EmbreeTracer(const std::vector<Corners>& triangles) {
  device_ = rtcNewDevice(nullptr);
  if (device_ == nullptr) fail(ErrorKind::device, "embree: no device could be made");
  scene_ = rtcNewScene(device_);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corners = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), triangles.size() * 3));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), triangles.size()));
  if (corners == nullptr || indices == nullptr)
    fail(ErrorKind::device, "embree: no memory for {} triangles", triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      corners[i * 3 + k] = triangles[i][k];
      indices[i * 3 + k] = static_cast<std::uint32_t>(i * 3 + k);
    }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
    fail(ErrorKind::device, "embree: the scene could not be built");
}

EmbreeTracer::~EmbreeTracer() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

unsigned EmbreeTracer::threads() {
  return std::max(1u, std::thread::hardware_concurrency());
}

void EmbreeTracer::trace(const std::vector<RayWords>& rays, std::vector<Met>& met) const {
  trace_each(
      rays.size(), [&](std::size_t i) -> const RayWords& { return rays[i]; },
      [&](std::size_t i, const Met& one) { met[i] = one; });
}

void EmbreeTracer::in_chunks(std::size_t count,
                             const std::function<void(std::size_t begin, std::size_t end)>& work) {
  constexpr std::size_t k_chunk = 2048;
  std::atomic<std::size_t> next{0};
  const auto until_done = [&] {
    flush_denormals();
    for (;;) {
      const std::size_t begin = next.fetch_add(k_chunk);
      if (begin >= count) return;
      work(begin, std::min(count, begin + k_chunk));
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < threads(); ++i)
    others.emplace_back(until_done);
  until_done();
}

Met EmbreeTracer::trace_one(const RayWords& r) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit hit{};
  hit.ray = {r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, r[6], ~0u, 0, 0};
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_, &context, &hit);
  return {hit.ray.tfar, hit.hit.primID, hit.hit.geomID != RTC_INVALID_GEOMETRY_ID};
}

std::array<Met, 16> EmbreeTracer::trace_packet(const std::array<RayWords, k_packet>& rays) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) std::array<int, k_packet> valid;
  RTCRayHit16 hits{};
  for (std::size_t k = 0; k < k_packet; ++k) {
    valid[k] = -1;
    hits.ray.org_x[k] = rays[k][0];
    hits.ray.org_y[k] = rays[k][1];
    hits.ray.org_z[k] = rays[k][2];
    hits.ray.dir_x[k] = rays[k][3];
    hits.ray.dir_y[k] = rays[k][4];
    hits.ray.dir_z[k] = rays[k][5];
    hits.ray.tfar[k] = rays[k][6];
    hits.ray.mask[k] = ~0u;
    hits.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect16(valid.data(), scene_, &context, &hits);
  std::array<Met, k_packet> met;
  for (std::size_t k = 0; k < k_packet; ++k)
    met[k] = {hits.ray.tfar[k], hits.hit.primID[k], hits.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID};
  return met;
}

}  // namespace ds
