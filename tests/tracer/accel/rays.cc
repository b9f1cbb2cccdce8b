// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/accel/rays.h"

#include "tracer/device/program_text.h"

#include <fmt/format.h>

#include <utility>

namespace ds::rays {

std::vector<Corners> corners_of(const Mesh& mesh) {
  std::vector<Corners> corners;
  for (const auto& t : mesh.triangles)
    corners.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  return corners;
}

Tree::Tree(std::span<const Corners> triangles, BvhQuality quality, int width)
    : Tree(build_bvh(triangles, quality, width)) {}

Tree::Tree(const Bvh& bvh)
    : device_(""),
      program_(device_.build(rays_program_text(), k_strict_options, DS_TEST_PROGRAMS)) {
  nodes_ = device_.upload(bvh.nodes);
  leaves_ = device_.upload(bvh.leaves);
}

Buffer Tree::upload_rays(std::span<const TestRay> rays, std::size_t padded) const {
  std::vector<float> words;
  for (const TestRay& r : rays)
    words.insert(words.end(), {r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y,
                               r.direction.z, r.t_max});
  words.resize(padded * 7, 1.0f);
  return device_.upload(words);
}

std::vector<TestHit> Tree::nearest(std::span<const TestRay> rays) const {
  const std::size_t padded = (rays.size() + 7) / 8 * 8;
  Kernel kernel = device_.kernel(program_, "trace_nearest");
  const Buffer out = device_.make_buffer(padded * sizeof(TestHit));
  kernel.set(0, nodes_);
  kernel.set(1, leaves_);
  kernel.set(2, upload_rays(rays, padded));
  kernel.set(3, out);
  device_.run(kernel, 0, padded, 8);
  std::vector<TestHit> hits(rays.size());
  device_.read(out, std::as_writable_bytes(std::span(hits)));
  return hits;
}

std::vector<std::uint32_t> Tree::any(std::span<const TestRay> rays) const {
  const std::size_t padded = (rays.size() + 7) / 8 * 8;
  Kernel kernel = device_.kernel(program_, "trace_any");
  const Buffer out = device_.make_buffer(padded * sizeof(std::uint32_t));
  kernel.set(0, nodes_);
  kernel.set(1, leaves_);
  kernel.set(2, upload_rays(rays, padded));
  kernel.set(3, out);
  device_.run(kernel, 0, padded, 8);
  std::vector<std::uint32_t> answers(rays.size());
  device_.read(out, std::as_writable_bytes(std::span(answers)));
  return answers;
}

Tree::Batched Tree::batched(std::span<const TestRay> rays, int lanes) const {
  const Program program =
      device_.build(rays_program_text(), fmt::format("{} -DDS_LANES={}", k_strict_options, lanes),
                    DS_TEST_PROGRAMS);
  const std::size_t padded = (rays.size() + 127) / 128 * 128;
  Kernel kernel = device_.kernel(program, "trace_batches");
  const Buffer out = device_.make_buffer(padded * 2 * sizeof(float));
  const Buffer answers = device_.make_buffer(padded * sizeof(std::uint32_t));
  kernel.set(0, nodes_);
  kernel.set(1, leaves_);
  kernel.set(2, upload_rays(rays, padded));
  kernel.set(3, std::uint32_t{1});
  kernel.set(4, out);
  kernel.set(5, answers);
  device_.run(kernel, 0, padded / static_cast<std::size_t>(lanes), 8);
  std::vector<std::pair<float, std::uint32_t>> words(rays.size());
  Batched result{std::vector<TestHit>(rays.size()), std::vector<std::uint32_t>(rays.size())};
  device_.read(out, std::as_writable_bytes(std::span(words)));
  device_.read(answers, std::as_writable_bytes(std::span(result.any)));
  for (std::size_t i = 0; i < words.size(); ++i)
    result.nearest[i] = {words[i].first, 0, 0, words[i].second};
  return result;
}

}  // namespace ds::rays
