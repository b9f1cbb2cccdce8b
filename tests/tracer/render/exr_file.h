// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/exr_header.h"

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ds::samples {

template <typename T>
void put_little(std::string& out, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  out.append(raw, sizeof(T));
}

inline std::string exr_attribute(std::string_view name, std::string_view type,
                                 const std::string& value) {
  std::string out = std::string(name) + '\0' + std::string(type) + '\0';
  put_little(out, static_cast<std::int32_t>(value.size()));
  return out + value;
}

inline std::string exr_box(const ExrBox& box) {
  std::string out;
  for (const std::int32_t x : {box.x0, box.y0, box.x1, box.y1})
    put_little(out, x);
  return out;
}

/// An OpenEXR file made by hand: one part, scan lines, floats, not compressed.
struct ExrFile {
  ExrBox display{0, 0, 3, 3};
  ExrBox data{0, 0, 3, 3};
  std::vector<std::string> channels{"B", "G", "R"};  ///< in ascending order, as the format wants
  std::string more;                                  ///< attributes
  std::int32_t sampling = 1;
  char compression = 0;
  std::function<float(const std::string& channel, int x, int y)> value = [](const std::string&, int,
                                                                            int) { return 0.5f; };

  std::string head() const {
    std::string list;
    for (const std::string& channel : channels) {
      list += channel + '\0';
      put_little<std::int32_t>(list, 2);
      put_little<std::int32_t>(list, 0);
      put_little(list, sampling);
      put_little(list, sampling);
    }
    std::string center, one;
    put_little(one, 1.0f);
    center.assign(8, '\0');
    return std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) +
           exr_attribute("channels", "chlist", list + '\0') +
           exr_attribute("compression", "compression", std::string(1, compression)) +
           exr_attribute("dataWindow", "box2i", exr_box(data)) +
           exr_attribute("displayWindow", "box2i", exr_box(display)) +
           exr_attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           exr_attribute("pixelAspectRatio", "float", one) +
           exr_attribute("screenWindowCenter", "v2f", center) +
           exr_attribute("screenWindowWidth", "float", one) + more + '\0';
  }

  std::string bytes() const {
    const std::string start = head();
    std::string table, body;
    const std::size_t rows = static_cast<std::size_t>(data.height());
    for (std::int32_t y = data.y0; y <= data.y1; ++y) {
      put_little<std::uint64_t>(table, start.size() + rows * 8 + body.size());
      put_little(body, y);
      put_little<std::int32_t>(body, static_cast<std::int32_t>(channels.size() * 4) *
                                         static_cast<std::int32_t>(data.width()));
      for (const std::string& channel : channels)
        for (std::int32_t x = data.x0; x <= data.x1; ++x)
          put_little(body, value(channel, x, y));
    }
    return start + table + body;
  }
};

}  // namespace ds::samples
