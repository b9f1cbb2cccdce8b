// SPDX-License-Identifier: Apache-2.0
// Prints the bits of the pictures of all effects, traced in a stated way; ci/bits and
// same_bits_test run it in processes of their own, where threads, CPU level and device are what the
// environment says:
//
//   picture_bits [--device NAME] [--lanes N] [--work-group N] [--full] [--high-bvh]
//                [--bvh-width N] [--item-pixels N] [--programs DIR] [--size WxH] [--spp N]
//                [--picture NAME]...
//
// Output: golden_bits.txt's lines (bits.h), then "device NAME".
#include "tests/render/bits.h"
#include "tracer/base/error.h"

#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>

namespace ds {
namespace {

int number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1)
    fail(ErrorKind::usage, "wanted a number, found \"{}\"", text);
  return value;
}

pictures::BitsRequest parse(int count, char** arguments) {
  pictures::BitsRequest request;
  for (int i = 1; i < count; ++i) {
    const std::string_view option = arguments[i];
    const auto value = [&]() -> std::string_view {
      if (++i == count) fail(ErrorKind::usage, "{} needs a value", option);
      return arguments[i];
    };
    if (option == "--full") {
      request.tracer.full_program = true;
    } else if (option == "--high-bvh") {
      request.tracer.high_quality_bvh = true;
    } else if (option == "--item-pixels") {
      request.tracer.item_pixels = number(value());
    } else if (option == "--bvh-width") {
      request.tracer.bvh_width = number(value());
    } else if (option == "--device") {
      request.tracer.device = value();
    } else if (option == "--lanes") {
      request.tracer.lanes = number(value());
    } else if (option == "--work-group") {
      request.tracer.work_group_size = number(value());
    } else if (option == "--programs") {
      request.tracer.cache_folder = value();
    } else if (option == "--size") {
      const std::string_view size = value();
      const std::size_t x = size.find('x');
      if (x == size.npos) fail(ErrorKind::usage, "--size wants WxH, found \"{}\"", size);
      request.width = number(size.substr(0, x));
      request.height = number(size.substr(x + 1));
    } else if (option == "--spp") {
      request.spp = number(value());
    } else if (option == "--picture") {
      request.names.emplace_back(value());
    } else {
      fail(ErrorKind::usage, "unknown option {}", option);
    }
  }
  return request;
}

}  // namespace
}  // namespace ds

int main(int count, char** arguments) {
  try {
    const ds::pictures::BitsRequest request = ds::parse(count, arguments);
    const std::string text = ds::pictures::to_text(ds::pictures::bits_of(request));
    std::fputs(text.c_str(), stdout);
    std::printf("device %s\n", ds::Tracer(request.tracer).device_name().c_str());
    return 0;
  } catch (const ds::Error& error) {
    std::fprintf(stderr, "picture_bits: %s\n", error.what());
    return ds::exit_code(error.kind());
  }
}
