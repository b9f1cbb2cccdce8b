// SPDX-License-Identifier: Apache-2.0
// Image files: whatever the bytes, a picture whose size the file can hold, or an Error. The library
// behind is loaded at run time and reports no coverage; what is set against it does.
#include "tracer/base/error.h"
#include "tracer/render/image_claims.h"
#include "tracer/render/image_meaning.h"

#include <cstddef>
#include <cstdint>

// An error in a picture's bytes leaves the library's PNG reader by longjmp, past the message that it
// has copied: a few bytes a broken file, lost there.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOpenImageIO";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto bytes = std::as_bytes(std::span(data, size));
    const ds::DecodedImage decoded = ds::decode_image_bytes(bytes, "fuzz.image", ds::Halves::widen);
    const ds::ImageMeaning meaning = ds::image_meaning(bytes, decoded, "fuzz.image");
    const auto pixels =
        static_cast<std::uint64_t>(meaning.width) * static_cast<std::uint64_t>(meaning.height);
    DS_ASSERT(pixels > 0 && pixels <= ds::believable_pixels(size));
    const auto stored = meaning.stored(meaning.width - 1, meaning.height - 1);
    DS_ASSERT(!stored || *stored < static_cast<std::size_t>(decoded.width) *
                                       static_cast<std::size_t>(decoded.height));
  } catch (const ds::Error& error) {
    DS_ASSERT(error.kind() == ds::ErrorKind::asset);
  }
  return 0;
}
