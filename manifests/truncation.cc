// SPDX-License-Identifier: Apache-2.0
#include "manifests/truncation.h"

#include "manifests/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ds {
namespace {

using Place = std::array<double, 2>;

constexpr double k_most_cells = 1 << 24U;
/// Farther from the picture's corner nothing is told from what has no end.
constexpr double k_most_pixels = 1e7;

/// The model's coordinates to pixels of the picture, whose centres are at .5.
class ToPicture {
 public:
  ToPicture(const ImageRecord& image, const ModelPose& pose)
      : image_(image), m_(model_to_camera(pose, image.camera_to_world)) {}

  /// Nothing for what is not before the camera, or far beyond the picture.
  std::optional<Place> operator()(Vec3d p) const {
    const auto row = [&](std::size_t i) {
      return m_[i] * p.x + m_[i + 1] * p.y + m_[i + 2] * p.z + m_[i + 3];
    };
    const double x = row(0), y = row(4), z = row(8);
    if (!(z > 0)) return std::nullopt;
    Place place{};
    if (image_.intrinsics) {
      const auto& k = *image_.intrinsics;
      place = {k[0] * x / z + k[2], k[4] * y / z + k[5]};
    } else {
      const double pitch = image_.metres_per_pixel.value_or(1);
      place = {x / pitch + image_.width / 2.0, y / pitch + image_.height / 2.0};
    }
    const bool is_near = std::abs(place[0]) < k_most_pixels && std::abs(place[1]) < k_most_pixels;
    return is_near ? std::optional(place) : std::nullopt;
  }

 private:
  const ImageRecord& image_;
  std::array<double, 16> m_;
};

bool box_is_inside(const ImageRecord& image, const Box& box, const ToPicture& to_picture) {
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto place = to_picture({(corner & 1U) != 0 ? box.most.x : box.least.x,
                                   (corner & 2U) != 0 ? box.most.y : box.least.y,
                                   (corner & 4U) != 0 ? box.most.z : box.least.z});
    if (!place || (*place)[0] < 0 || (*place)[1] < 0 || (*place)[0] > image.width ||
        (*place)[1] > image.height)
      return false;
  }
  return true;
}

PixelCounts counted(std::uint64_t beyond, std::optional<std::uint64_t> whole) {
  PixelCounts counts;
  counts.beyond = beyond;
  counts.whole = whole;
  return counts;
}

}  // namespace

std::optional<PixelCounts> count_beyond(const ImageRecord& image,
                                        const std::function<const FileMesh&()>& mesh) {
  if (!image.pose) return std::nullopt;
  return count_beyond(image, *image.pose, mesh);
}

PixelCounts count_beyond(const ImageRecord& image, const ModelPose& pose,
                         const std::function<const FileMesh&()>& mesh) {
  const ToPicture to_picture(image, pose);
  if (box_is_inside(image, pose.model_box, to_picture)) return counted(0, std::nullopt);
  const FileMesh& model = mesh();
  std::vector<Place> places;
  places.reserve(model.positions.size());
  Place least{k_most_pixels, k_most_pixels}, most{-k_most_pixels, -k_most_pixels};
  for (const Vec3d p : model.positions) {
    const auto place = to_picture(p);
    if (!place) return counted(0, 0);
    places.push_back(*place);
    for (std::size_t i = 0; i < 2; ++i) {
      least[i] = std::min(least[i], (*place)[i]);
      most[i] = std::max(most[i], (*place)[i]);
    }
  }
  if (places.empty()) return counted(0, 0);
  int step = 1;
  while ((most[0] - least[0]) / step * ((most[1] - least[1]) / step) > k_most_cells)
    ++step;
  const auto cell = [&](double place) { return static_cast<int>(std::floor(place / step)); };
  const int x0 = cell(least[0]), y0 = cell(least[1]);
  Canvas canvas(x0, y0, cell(most[0]) - x0 + 1, cell(most[1]) - y0 + 1);
  for (Place& place : places)
    place = {place[0] / step, place[1] / step};
  for (const auto& t : model.triangles)
    canvas.cover(places[t[0]], places[t[1]], places[t[2]]);
  std::uint64_t beyond = 0, whole = 0;
  canvas.visit([&](int x, int y) {
    const double at_x = (x + 0.5) * step, at_y = (y + 0.5) * step;
    ++whole;
    beyond += at_x < 0 || at_y < 0 || at_x > image.width || at_y > image.height ? 1U : 0U;
  });
  const auto each = static_cast<std::uint64_t>(step) * static_cast<std::uint64_t>(step);
  return counted(beyond * each, whole * each);
}

}  // namespace ds
