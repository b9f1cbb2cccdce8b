// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/photons.h"

#include "tracer/base/error.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/lists.h"
#include "tracer/kernels/prepared.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>

namespace ds {
namespace {

using kernels::natural;
using kernels::real2;
using kernels::real3;

constexpr int k_most_bounces = 4;
/// Pairs of dimensions of a photon's sampler.
enum { k_pair_start, k_pair_place, k_pair_light, k_pair_bounces };

Vec3 plain(real3 v) {
  return {v.x, v.y, v.z};
}

/// Words as the kernels' functions take them.
std::vector<float> floats(const Words& words) {
  std::vector<float> values(words.words().size());
  if (!values.empty())
    std::memcpy(values.data(), words.words().data(), values.size() * sizeof(float));
  return values;
}

/// `type`: row of material_types(), of one that scatters.
kernels::BsdfSample sample_material(int type, const float* inputs, kernels::Viewer viewer, real2 u,
                                    real2 lobe) {
  using namespace kernels;
  int row = 0;
#define DS_SAMPLE_ROW(sdl_name, prefix, PREFIX) \
  if (type == row++) return prefix##_sample(DS_PREPARED(prefix, inputs, viewer), viewer, u, lobe);
  DS_SCATTERING_MATERIALS(DS_SAMPLE_ROW)
  return no_sample();
}

/// The child that a chooser takes; `*choice` is used up and stretched back to [0, 1).
natural chosen_child(std::string_view prefix, const float* inputs, kernels::mask outside,
                     float* choice) {
  using namespace kernels;
#define DS_CHILD_OF(sdl_name, name, NAME) \
  if (prefix == #name) return name##_child(inputs, outside, all_lanes(), choice);
  DS_CHOOSING_MATERIALS(DS_CHILD_OF)
  return 0;
}

kernels::LightSample sample_light(std::string_view kind, kernels::LightTables tables, natural at,
                                  real3 from, real2 u) {
#define DS_SAMPLE_KIND(sdl_name, prefix) \
  if (kind == #prefix) return kernels::prefix##_sample(tables, at, from, u);
  DS_ALL_LIGHTS(DS_SAMPLE_KIND)
  return kernels::no_light();
}

/// What there is to know of a material here.
struct Substance {
  int type;                   ///< row of material_types()
  std::vector<float> inputs;  ///< and numbers, as the kernels read them
  std::array<int, kernels::k_most_children> children;
  bool casts = false, receives = false;  ///< caustics, itself or a part of it
};

std::vector<Substance> substances(const Scene& scene) {
  const std::vector<bool> casts = materials_with(scene, kernels::k_trait_casts_caustics);
  const std::vector<bool> receives = materials_with(scene, kernels::k_trait_receives_caustics);
  std::vector<Substance> list;
  for (const Material& material : scene.materials) {
    const NodeType& type = material_types()[static_cast<std::size_t>(material.type)];
    Substance s;
    s.type = material.type;
    s.casts = casts[list.size()];
    s.receives = receives[list.size()];
    std::copy(std::begin(material.children), std::end(material.children), s.children.begin());
    for (std::size_t i = 0; i < type.inputs.size(); ++i) {
      const bool wide = type.inputs[i].width == 3;
      const float instead = wide ? 0.5f : 0.1f;
      const Vec3 value = material.inputs[i].texture < 0 ? material.inputs[i].constant
                                                        : Vec3{instead, instead, instead};
      s.inputs.push_back(value.x);
      if (wide) s.inputs.insert(s.inputs.end(), {value.y, value.z});
    }
    s.inputs.insert(s.inputs.end(), material.numbers.begin(), material.numbers.end());
    list.push_back(std::move(s));
  }
  return list;
}

/// A photon on its way from a surface that casts caustics.
struct Flight {
  natural number;  ///< its sampler's
  natural triangle;
  float b1, b2;
  real3 from;      ///< unit: to where it came from
  real3 source{};  ///< where it left last
  float power;
};

/// The surface under a flight, seen from where it came from.
kernels::Surface surface_under(const std::vector<float>& triangles, const Flight& flight) {
  const float* row = triangles.data() + std::size_t{flight.triangle} * kernels::k_triangle_words;
  kernels::Corners corners;
  for (natural i = 0; i < 3; ++i) {
    corners.position[i] = kernels::load3(row, kernels::k_triangle_positions + 3 * i);
    corners.normal[i] = kernels::load3(row, kernels::k_triangle_normals + 3 * i);
  }
  return kernels::surface_at(&corners, flight.b1, flight.b2, flight.from);
}

RayWords ray_from(real3 origin, real3 direction, float t_max) {
  return {{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, t_max};
}

class PhotonTracer {
 public:
  PhotonTracer(const Scene& scene, const PackedScene& packed, const SceneEffects& effects,
               const TraceRays& trace)
      : trace_(trace),
        substances_(substances(scene)),
        triangles_(floats(packed.triangles)),
        lights_(floats(packed.lights)),
        tables_(floats(packed.tables)) {
    double sum = 0;
    const std::vector<std::uint32_t> first = first_triangles(scene);
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
      const Object& object = scene.objects[o];
      if (object.id != k_model_object_id) continue;
      for (std::size_t i = 0; i < object.mesh.triangles.size(); ++i) {
        const int material = material_of_triangle(object, i);
        if (material < 0 || !substances_[static_cast<std::size_t>(material)].casts) continue;
        const auto number = static_cast<natural>(first[o] + i);
        sum += area(number);
        casters_.push_back(number);
        casters_until_.push_back(sum);
      }
    }
    for (natural i = 0; i < packed.data.light_count; ++i) {
      const float kind = lights_[i * kernels::k_light_words + kernels::k_light_kind];
      const std::string& name = effects.lights[std::bit_cast<std::uint32_t>(kind)];
      if (has_trait(light_type(name), kernels::k_trait_small) &&
          lights_[i * kernels::k_light_words + kernels::k_light_probability] > 0)
        sampled_.push_back({i, name});
    }
  }

  std::vector<Photon> photons(std::size_t most) {
    if (casters_.empty() || !(casters_until_.back() > 0) || sampled_.empty()) return {};
    std::vector<Flight> flights = start(most);
    std::vector<Photon> found;
    for (int bounce = 0; bounce < k_most_bounces && !flights.empty(); ++bounce)
      flights = go_on(flights, bounce, found);
    return found;
  }

 private:
  struct Sampled {
    natural row;
    std::string_view kind;
  };

  double area(natural triangle) const {
    const float* row = triangles_.data() + std::size_t{triangle} * kernels::k_triangle_words;
    const auto at = [&](std::size_t i) {
      return Vec3d{row[3 * i], row[3 * i + 1], row[3 * i + 2]};
    };
    const Vec3d normal = cross(at(1) - at(0), at(2) - at(0));
    return std::sqrt(dot(normal, normal)) / 2;
  }
  const Substance& substance_of(natural triangle) const {
    const float word = triangles_[std::size_t{triangle} * kernels::k_triangle_words +
                                  kernels::k_triangle_material];
    return substances_[std::bit_cast<std::uint32_t>(word)];
  }
  static kernels::Sampler sampler(natural number) { return kernels::sampler_for(0, 0, 0, number); }

  /// On the triangles that cast caustics, where a light shines on them.
  std::vector<Flight> start(std::size_t most) const {
    std::vector<Flight> flights;
    std::vector<RayWords> rays;
    const kernels::LightTables tables{lights_.data(), tables_.data(), triangles_.data()};
    for (std::size_t i = 0; i < most; ++i) {
      Flight flight{};
      flight.number = static_cast<natural>(i);
      const kernels::Sampler s = sampler(flight.number);
      const real2 which = sample_pair(s, k_pair_start);
      const double until = double{which.x} * casters_until_.back();
      const auto place = std::upper_bound(casters_until_.begin(), casters_until_.end() - 1, until);
      flight.triangle = casters_[static_cast<std::size_t>(place - casters_until_.begin())];
      const real2 u = sample_pair(s, k_pair_place);
      const float root = std::sqrt(u.x);
      flight.b1 = root * (1 - u.y);
      flight.b2 = root * u.y;
      const auto light = static_cast<std::size_t>(double{which.y} * double(sampled_.size()));
      const Sampled& from = sampled_[std::min(light, sampled_.size() - 1)];
      flight.from = kernels::vec(0, 0, 1);
      const kernels::Surface at = surface_under(triangles_, flight);
      const kernels::LightSample l = sample_light(
          from.kind, tables, from.row * kernels::k_light_words + kernels::k_light_parameters,
          at.position, sample_pair(s, k_pair_light));
      if (!(l.pdf > 0)) continue;
      flight.from = l.wi;
      const kernels::Surface seen = surface_under(triangles_, flight);
      flight.power = luminance(l.radiance) / l.pdf * dot(seen.normal, l.wi);
      if (!(flight.power > 0) || !std::isfinite(flight.power)) continue;
      const real3 origin = offset_origin(seen.position, seen.error, seen.normal, l.wi);
      const real3 way = sub(l.target, origin);
      flights.push_back(flight);
      rays.push_back(
          ray_from(origin, l.wi, l.bounded ? std::sqrt(dot(way, way)) * 0.9999f : 1e30f));
    }
    const std::vector<RayAnswer> answers = trace_(rays);
    std::vector<Flight> lit;
    for (std::size_t i = 0; i < flights.size(); ++i)
      if (answers[i].triangle == k_none) lit.push_back(flights[i]);
    return lit;
  }

  /// Off the surfaces they are on, to the next.
  std::vector<Flight> go_on(std::vector<Flight>& flights, int bounce,
                            std::vector<Photon>& found) const {
    std::vector<Flight> gone;
    std::vector<RayWords> rays;
    for (Flight& flight : flights) {
      const kernels::Sampler s = sampler(flight.number);
      const auto pair = static_cast<natural>(k_pair_bounces + 2 * bounce);
      real2 lobe = sample_pair(s, pair + 1);
      const Substance* material = &substance_of(flight.triangle);
      const kernels::Surface at = surface_under(triangles_, flight);
      for (;;) {
        const NodeType& type = material_types()[static_cast<std::size_t>(material->type)];
        if (type.children == 0) break;
        const natural child =
            chosen_child(type.kernel_prefix, material->inputs.data(), at.outside, &lobe.y);
        material = &substances_[static_cast<std::size_t>(material->children[child])];
      }
      lobe.y = 0;
      const kernels::Frame frame = kernels::frame_around(at.shading);
      kernels::Viewer viewer{to_local(frame, flight.from), at.outside};
      viewer.wo.z = std::max(viewer.wo.z, 1e-3f);
      const kernels::BsdfSample b = sample_material(material->type, material->inputs.data(), viewer,
                                                    sample_pair(s, pair), lobe);
      if (!b.valid || !(b.glossy || b.specular)) continue;
      // Mirrored on the true plane where that lets it leave on its lobe's side (leaving.h).
      const real3 sampled = unit(to_world(frame, b.wi));
      const bool crosses = (b.wi.z > 0) != (dot(sampled, at.normal) > 0);
      const real3 wi = crosses ? mirror_image(sampled, at.normal) : sampled;
      flight.power *= luminance(b.weight);
      if (!(flight.power > 0) || !std::isfinite(flight.power)) continue;
      flight.source = at.position;
      flight.from = negate(wi);
      gone.push_back(flight);
      rays.push_back(ray_from(offset_origin(at.position, at.error, at.normal, wi), wi, 1e30f));
    }
    const std::vector<RayAnswer> answers = trace_(rays);
    std::vector<Flight> next;
    for (std::size_t i = 0; i < gone.size(); ++i) {
      if (answers[i].triangle == k_none) continue;
      Flight& flight = gone[i];
      flight.triangle = answers[i].triangle;
      flight.b1 = answers[i].b1;
      flight.b2 = answers[i].b2;
      const Substance& material = substance_of(flight.triangle);
      if (material.receives)
        found.push_back({plain(surface_under(triangles_, flight).position), plain(flight.source),
                         flight.power});
      if (material.casts) next.push_back(flight);
    }
    return next;
  }

  const TraceRays& trace_;
  std::vector<Substance> substances_;
  std::vector<float> triangles_, lights_, tables_;
  std::vector<natural> casters_;
  std::vector<double> casters_until_;  ///< cumulative areas
  std::vector<Sampled> sampled_;
};

}  // namespace

std::vector<Photon> trace_photons(const Scene& scene, const PackedScene& packed,
                                  const SceneEffects& effects, std::size_t most,
                                  const TraceRays& trace) {
  return PhotonTracer(scene, packed, effects, trace).photons(most);
}

}  // namespace ds
