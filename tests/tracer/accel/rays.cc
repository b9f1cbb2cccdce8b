// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/accel/rays.h"

#include "tracer/device/program_text.h"

namespace ds::rays {

Tree::Tree(std::span<const Corners> triangles, BvhQuality quality)
    : device_(""),
      program_(device_.build(rays_program_text(), k_strict_options, DS_TEST_PROGRAMS)) {
  const Bvh bvh = build_bvh(triangles, quality);
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

}  // namespace ds::rays
