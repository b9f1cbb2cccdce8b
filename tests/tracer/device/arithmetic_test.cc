// SPDX-License-Identifier: Apache-2.0
// The arithmetic that strict programs are built on, held against the host's IEEE 754 arithmetic.
#include "tracer/base/files.h"
#include "tracer/device/opencl.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace ds {
namespace {

constexpr std::size_t k_count = 1 << 20;

/// Every bit pattern is as likely as any other, so that denormals, infinities and huge ratios all
/// come up.
std::vector<float> random_bits(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> values(k_count);
  for (float& value : values)
    value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
  return values;
}

/// Both kernels, one value and eight values a work-item, write r = f(a, b, c) for each element.
void expect_same_bits(const std::string& expression,
                      const std::function<float(float, float, float)>& expected) {
  const TemporaryFolder cache;
  const Device device("");
  const std::vector<float> a = random_bits(1), b = random_bits(2), c = random_bits(3);
  for (const std::size_t lanes : {1u, 8u}) {
    const std::string type = lanes == 1 ? "float" : "float8";
    const std::string source = "#pragma OPENCL FP_CONTRACT OFF\n__kernel void f(__global const " +
                               type + "* pa, __global const " + type + "* pb, __global const " +
                               type + "* pc, __global " + type +
                               "* r) { size_t i = get_global_id(0); " + type +
                               " a = pa[i], b = pb[i], c = pc[i]; r[i] = " + expression + "; }";
    Kernel kernel = device.kernel(device.build(source, k_strict_options, cache.path()), "f");
    const Buffer out = device.make_buffer(k_count * sizeof(float));
    kernel.set(0, device.upload(a));
    kernel.set(1, device.upload(b));
    kernel.set(2, device.upload(c));
    kernel.set(3, out);
    device.run(kernel, 0, k_count / lanes, 64);
    std::vector<float> r(k_count);
    device.read(out, std::as_writable_bytes(std::span(r)));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < k_count; ++i) {
      const float want = expected(a[i], b[i], c[i]);
      const bool same = std::bit_cast<std::uint32_t>(r[i]) == std::bit_cast<std::uint32_t>(want);
      if (same || (std::isnan(r[i]) && std::isnan(want))) continue;  // a NaN's payload is free
      if (++wrong <= 3)
        ADD_FAILURE() << expression << ", " << lanes << " lanes: " << std::hexfloat << a[i] << " "
                      << b[i] << " " << c[i] << " gives " << r[i] << ", wanted " << want;
    }
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(StrictArithmetic, DivideRoundsCorrectly) {
  expect_same_bits("a / b", [](float a, float b, float) { return a / b; });
}

TEST(StrictArithmetic, SqrtRoundsCorrectly) {
  expect_same_bits("sqrt(a)", [](float a, float, float) { return std::sqrt(a); });
}

TEST(StrictArithmetic, NothingIsContracted) {
  expect_same_bits("a * b + c", [](float a, float b, float c) { return a * b + c; });
}

TEST(StrictArithmetic, FmaIsFused) {
  expect_same_bits("fma(a, b, c)", [](float a, float b, float c) { return std::fma(a, b, c); });
}

TEST(StrictArithmetic, DenormalsSurvive) {
  expect_same_bits("a * 0x1p-100f + b * 0x1p-40f",
                   [](float a, float b, float) { return a * 0x1p-100f + b * 0x1p-40f; });
}

TEST(StrictArithmetic, TheContractionTestCanFail) {
  // Fused and unfused results differ for these, so that the test above would notice.
  const float a = 1.0f + 0x1p-12f, c = -(1.0f + 0x1p-11f);
  EXPECT_EQ(a * a + c, 0.0f);
  EXPECT_EQ(std::fma(a, a, c), 0x1p-24f);
}

}  // namespace
}  // namespace ds
