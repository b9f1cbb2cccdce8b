// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/guide.h"

#include "tracer/kernels/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace ds {
namespace {

constexpr std::size_t k_least_photons = 4;  ///< that make a cell look anywhere

/// Cells along a side. Photons fall on surfaces: a quarter of them in cells of twice the size are as
/// many in each.
std::size_t side_for(std::size_t photons) {
  return photons < k_photons_of_fine_cells ? 32 : 64;
}

/// A photon's source, and what it counts for.
struct Source {
  Vec3d at;
  double weight;
};

/// Sources in a row, and the sphere around them.
struct Cluster {
  std::size_t begin, end;
  Vec3d mean{};
  double weight = 0;
  std::array<double, 3> variance{};  ///< along each axis

  double spread() const { return variance[0] + variance[1] + variance[2]; }
  std::size_t widest() const {
    return static_cast<std::size_t>(std::max_element(variance.begin(), variance.end()) -
                                    variance.begin());
  }
};

Cluster cluster_of(std::span<const Source> sources, std::size_t begin, std::size_t end) {
  Cluster c{begin, end};
  for (const Source& s : sources.subspan(begin, end - begin)) {
    c.weight += s.weight;
    c.mean = c.mean + s.weight * s.at;
  }
  c.mean = (1 / c.weight) * c.mean;
  for (const Source& s : sources.subspan(begin, end - begin)) {
    const Vec3d away = s.at - c.mean;
    for (int axis = 0; axis < 3; ++axis)
      c.variance[static_cast<std::size_t>(axis)] += s.weight * away[axis] * away[axis] / c.weight;
  }
  return c;
}

/// The most spread out one is split at its mean, time and again.
std::vector<Cluster> clusters_of(std::span<Source> sources) {
  std::vector<Cluster> clusters{cluster_of(sources, 0, sources.size())};
  while (clusters.size() < kernels::k_guide_lobes) {
    const auto widest =
        std::max_element(clusters.begin(), clusters.end(), [](const Cluster& a, const Cluster& b) {
          return a.weight * a.spread() < b.weight * b.spread();
        });
    const int axis = static_cast<int>(widest->widest());
    const auto first = sources.begin() + static_cast<std::ptrdiff_t>(widest->begin);
    const auto last = sources.begin() + static_cast<std::ptrdiff_t>(widest->end);
    const double middle = widest->mean[axis];
    const auto half =
        std::stable_partition(first, last, [&](const Source& s) { return s.at[axis] < middle; });
    if (half == first || half == last) break;
    const auto border = static_cast<std::size_t>(half - sources.begin());
    const std::size_t end = widest->end;
    *widest = cluster_of(sources, widest->begin, border);
    clusters.push_back(cluster_of(sources, border, end));
  }
  return clusters;
}

class Cube {
 public:
  Cube(Vec3 centre, float radius, std::size_t side)
      : side_(side),
        half_(4 * double{radius}),
        low_{double{centre.x} - half_, double{centre.y} - half_, double{centre.z} - half_},
        per_metre_(static_cast<double>(side) / (2 * half_)) {}
  std::size_t side() const { return side_; }
  Vec3d low() const { return low_; }
  double per_metre() const { return per_metre_; }
  /// The cell along each axis; may lie outside.
  std::array<long, 3> cell(Vec3 at) const {
    const Vec3d p = per_metre_ * (to_double(at) - low_);
    const auto held = [&](double x) {
      return static_cast<long>(std::floor(std::clamp(x, -10.0, static_cast<double>(side_) + 10)));
    };
    return {held(p.x), held(p.y), held(p.z)};
  }

 private:
  std::size_t side_;
  double half_;
  Vec3d low_;
  double per_metre_;
};

std::uint32_t bits(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

/// The photons of each cell of the cube. Most cells have none, and are passed over in a few steps of
/// a row of numbers: a small picture's table is made of a few thousand photons.
class PhotonCells {
 public:
  PhotonCells(std::span<const Photon> photons, const Cube& cube)
      : side_(static_cast<long>(cube.side())),
        cells_(cube.side() * cube.side() * cube.side()),
        begin_(cells_ + 1, 0),
        near_((cube.side() + 2) * (cube.side() + 2) * (cube.side() + 2), 0) {
    std::vector<std::size_t> place;
    place.reserve(photons.size());
    for (const Photon& photon : photons) {
      const auto [x, y, z] = cube.cell(photon.position);
      const bool inside = is_inside(x) && is_inside(y) && is_inside(z);
      place.push_back(inside ? number(x, y, z) : cells_);
      if (!inside) continue;
      ++begin_[number(x, y, z) + 1];
    }
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      if (begin_[cell + 1] > 0) count_near(cell, begin_[cell + 1]);
      begin_[cell + 1] += begin_[cell];
    }
    // In the photons' order within a cell: sums depend on it.
    sources_.resize(begin_[cells_]);
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < photons.size(); ++i)
      if (place[i] < cells_)
        sources_[next[place[i]]++] = {to_double(photons[i].source), double{photons[i].power}};
  }
  std::size_t number(long x, long y, long z) const {
    return static_cast<std::size_t>((z * side_ + y) * side_ + x);
  }
  std::size_t count() const { return cells_; }
  /// Photons that `gather` finds.
  std::size_t near(long x, long y, long z) const { return near_[rim_number(x, y, z)]; }
  /// Of a cell and, for less, of the 26 around it: a cell's own are few.
  void gather(long x, long y, long z, std::vector<Source>& sources) const {
    sources.clear();
    for (long w = z - 1; w < z + 2; ++w)
      for (long v = y - 1; v < y + 2; ++v)
        for (long u = x - 1; u < x + 2; ++u) {
          if (!is_inside(u) || !is_inside(v) || !is_inside(w)) continue;
          const double share = u == x && v == y && w == z ? 1 : 0.125;
          const std::size_t cell = number(u, v, w);
          for (std::size_t i = begin_[cell]; i < begin_[cell + 1]; ++i)
            sources.push_back({sources_[i].at, share * sources_[i].weight});
        }
  }

 private:
  bool is_inside(long i) const { return i >= 0 && i < side_; }
  std::size_t rim_number(long x, long y, long z) const {
    const long rim_side = side_ + 2;  // with the cells just outside
    return static_cast<std::size_t>(((z + 1) * rim_side + y + 1) * rim_side + x + 1);
  }
  void count_near(std::size_t cell, std::uint32_t count) {
    const long i = static_cast<long>(cell);
    const long x = i % side_, y = i / side_ % side_, z = i / (side_ * side_);
    for (long w = z - 1; w < z + 2; ++w)
      for (long v = y - 1; v < y + 2; ++v)
        for (long u = x - 1; u < x + 2; ++u)
          near_[rim_number(u, v, w)] += count;
  }

  long side_;
  std::size_t cells_;
  std::vector<Source> sources_;       ///< of the first cell, of the second, ...
  std::vector<std::uint32_t> begin_;  ///< of each cell in sources_, and the end
  std::vector<std::uint32_t> near_;   ///< photons in and around each cell
};

/// Spheres that hold nearly all of their sources, and are no points where a few photons agree.
void add_lobes(std::span<Source> sources, double radius, std::vector<std::uint32_t>& words) {
  double all = 0;
  for (const Source& s : sources)
    all += s.weight;
  const std::size_t begin = words.size();
  words.resize(begin + std::size_t{kernels::k_guide_lobes} * kernels::k_guide_lobe_words, 0);
  std::uint32_t* lobe = words.data() + begin;
  for (const Cluster& c : clusters_of(sources)) {
    const double wide = 1.6 * std::sqrt(c.spread()) + 0.02 * radius;
    lobe[0] = bits(c.mean.x);
    lobe[1] = bits(c.mean.y);
    lobe[2] = bits(c.mean.z);
    lobe[kernels::k_guide_radius2] = bits(wide * wide);
    lobe[kernels::k_guide_weight] = bits(c.weight / all);
    lobe += kernels::k_guide_lobe_words;
  }
}

}  // namespace

std::vector<std::uint32_t> guide_table(std::span<const Photon> photons, std::size_t started,
                                       Vec3 centre, float radius) {
  // No side: every place is outside.
  if (photons.empty()) return std::vector<std::uint32_t>(kernels::k_guide_cells, 0);
  const Cube cube(centre, radius, side_for(started));
  const PhotonCells cells(photons, cube);
  const auto side = static_cast<long>(cube.side());
  std::vector<std::uint32_t> words(kernels::k_guide_cells + cells.count(), 0);
  words[kernels::k_guide_side] = static_cast<std::uint32_t>(side);
  words[kernels::k_guide_origin] = bits(cube.low().x);
  words[kernels::k_guide_origin + 1] = bits(cube.low().y);
  words[kernels::k_guide_origin + 2] = bits(cube.low().z);
  words[kernels::k_guide_per_metre] = bits(cube.per_metre());
  std::vector<Source> sources;
  for (long z = 0; z < side; ++z)
    for (long y = 0; y < side; ++y)
      for (long x = 0; x < side; ++x) {
        if (cells.near(x, y, z) < k_least_photons) continue;
        cells.gather(x, y, z, sources);
        words[kernels::k_guide_cells + cells.number(x, y, z)] =
            static_cast<std::uint32_t>(words.size());
        add_lobes(sources, double{radius}, words);
      }
  return words;
}

}  // namespace ds
