// SPDX-License-Identifier: Apache-2.0
// What an error target saves against the same number of samples for every pixel:
//
//   adaptive_bench ASSETS MODEL [PIXELS [REPEATS [image | model]]]
//
// For each environment x material pair of ASSETS a picture of PIXELS x PIXELS (96) is traced with
// 32 to 512 samples a pixel and by a Schedule with as many samples in all, REPEATS times (3) with
// different seeds, taking turns, so that other work on the machine hits both alike. Errors are
// those of the developed pictures against one of 4096 samples and another seed, over all pixels or
// over those that show the model (engine.error_region). The uniform pictures give curves of error
// over seconds and over samples, log-log between their points; a pair's ratio is what the Schedule
// took over what the curve has at the Schedule's error. Prints a line a pair and the medians, as
// text.
#include "tracer/base/error.h"
#include "tracer/render/develop.h"
#include "tracer/render/images.h"
#include "tracer/render/render.h"
#include "tracer/scene/sdl.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr std::array k_curve_spp{32, 64, 128, 256, 512};
constexpr std::array k_scheduled_spp{64, 128};
constexpr int k_truth_spp = 4096;

struct Measured {
  double seconds = 0, samples = 0, squared_error = 0;
  double error() const { return std::sqrt(squared_error); }
};

std::vector<fs::path> sorted(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_directory() || entry.path().extension() == ".mat") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Mean squared difference of the developed pictures over the squared mean of the truth, over the
/// pixels that are not 0 in `region`.
double squared_error(const Film& film, const Film& truth, const ToneCurve& curve,
                     const std::vector<std::uint8_t>& region) {
  double squares = 0, mean = 0, count = 0;
  for (std::size_t i = 0; i < film.rgb.size(); i += 3) {
    if (region[i / 3] == 0) continue;
    count += 3;
    const auto at = [&](const Film& f) { return curve.at({f.rgb[i], f.rgb[i + 1], f.rgb[i + 2]}); };
    const auto a = at(film), b = at(truth);
    for (std::size_t c = 0; c < 3; ++c) {
      squares += (a[c] - b[c]) * (a[c] - b[c]);
      mean += b[c];
    }
  }
  return squares / count / (mean / count * (mean / count));
}

class Pair {
 public:
  Pair(const Scene& scene, EngineSettings engine, ErrorRegion region)
      : scene_(scene), engine_(engine), region_(region), tracer_({}) {
    camera_.position = normalized(Vec3d{1, 1, 1}) * 0.252;
    tracer_.set_scene(scene_);
    mask_ = tracer_.trace_geometry(camera_, engine_.width, engine_.height).mask;
    if (region_ == ErrorRegion::image) mask_.assign(mask_.size(), 255);
    engine_.spp = k_truth_spp;
    engine_.seed = 1;
    truth_ = tracer_.trace(camera_, engine_);
  }

  void run(int repeats) {
    const ToneCurve curve(scene_.tone_map, tone_map_scale(truth_, scene_.tone_map));
    for (int i = 0; i < repeats; ++i) {
      engine_.seed = 1000 + static_cast<std::uint64_t>(i);
      for (std::size_t k = 0; k < k_curve_spp.size(); ++k) {
        engine_.target.reset();
        engine_.spp = k_curve_spp[k];
        add(uniform[k], curve, repeats);
      }
      for (std::size_t k = 0; k < k_scheduled_spp.size(); ++k) {
        // No picture is that exact: the samples end it.
        engine_.target = ErrorTarget{1e-6, k_scheduled_spp[k], scene_.tone_map, region_};
        add(scheduled[k], curve, repeats);
      }
    }
  }

  /// Seconds (or samples) that the uniform pictures take to an error, beyond the ends along the
  /// last segments.
  double uniform_cost(double error, double Measured::*cost) const {
    std::size_t k = 0;
    while (k + 2 < uniform.size() && uniform[k + 1].error() > error)
      ++k;
    const double e0 = std::log(uniform[k].error()), e1 = std::log(uniform[k + 1].error());
    const double t0 = std::log(uniform[k].*cost), t1 = std::log(uniform[k + 1].*cost);
    return std::exp(t0 + (t1 - t0) * (std::log(error) - e0) / (e1 - e0));
  }

  std::array<Measured, k_curve_spp.size()> uniform{};
  std::array<Measured, k_scheduled_spp.size()> scheduled{};

 private:
  void add(Measured& to, const ToneCurve& curve, int repeats) {
    const auto begin = std::chrono::steady_clock::now();
    const Film film = tracer_.trace(camera_, engine_);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    to.seconds += seconds.count() / repeats;
    to.samples += static_cast<double>(film.traced_samples) / repeats;
    to.squared_error += squared_error(film, truth_, curve, mask_) / repeats;
  }

  const Scene& scene_;
  EngineSettings engine_;
  ErrorRegion region_;
  std::vector<std::uint8_t> mask_;
  Camera camera_;
  Tracer tracer_;
  Film truth_;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

void measure(const fs::path& assets, const fs::path& model, int pixels, int repeats,
             ErrorRegion region) {
  std::array<std::vector<double>, k_scheduled_spp.size()> times, counts;
  for (const fs::path& place : sorted(assets / "environments"))
    for (const fs::path& substance : sorted(assets / "materials")) {
      Scene scene = compose(read_environment(place), read_material(substance),
                            normalise(read_model(model).mesh, {}));
      load_images(scene);
      EngineSettings engine;
      engine.width = engine.height = pixels;
      Pair pair(scene, engine, region);
      pair.run(repeats);
      std::string line =
          fmt::format("{:<10} {:<17}", place.filename().string(), substance.stem().string());
      for (std::size_t k = 0; k < k_scheduled_spp.size(); ++k) {
        const Measured& s = pair.scheduled[k];
        times[k].push_back(s.seconds / pair.uniform_cost(s.error(), &Measured::seconds));
        counts[k].push_back(s.samples / pair.uniform_cost(s.error(), &Measured::samples));
        line += fmt::format("  {} spp: error {:.4f} (uniform {:.4f}), time {:.2f}, samples {:.2f}",
                            k_scheduled_spp[k], s.error(), pair.uniform[k + 1].error(),
                            times[k].back(), counts[k].back());
      }
      fmt::print("{}\n", line);
      std::fflush(stdout);
    }
  for (std::size_t k = 0; k < k_scheduled_spp.size(); ++k)
    fmt::print("medians at {} spp: time {:.2f}, samples {:.2f}\n", k_scheduled_spp[k],
               median(times[k]), median(counts[k]));
}

}  // namespace
}  // namespace ds

int main(int count, char** arguments) {
  try {
    const std::string region = count > 5 ? arguments[5] : "image";
    if (count < 3 || count > 6 || (region != "image" && region != "model"))
      ds::fail(ds::ErrorKind::usage, "wanted ASSETS MODEL [PIXELS [REPEATS [image | model]]]");
    ds::measure(arguments[1], arguments[2], count > 3 ? std::stoi(arguments[3]) : 96,
                count > 4 ? std::stoi(arguments[4]) : 3,
                region == "model" ? ds::ErrorRegion::model : ds::ErrorRegion::image);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "adaptive_bench: error: %s\n", error.what());
    return 1;
  }
}
