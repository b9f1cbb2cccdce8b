// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/keys.h"

#include "builder/recipe/class_keys.h"
#include "builder/recipe/distractors.h"
#include "manifests/check/check.h"
#include "tracer/base/nearest.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace ds {
namespace {

constexpr KeyRange k_any{};
constexpr KeyRange at_least(double least) {
  return {.least = least};
}
constexpr double k_far_m = 1e6;  // beyond it a single-precision tracer has nothing to say
constexpr KeyRange k_coordinate{.least = -k_far_m, .most = k_far_m};
constexpr KeyRange k_distance{.least = 0, .most = k_far_m, .open_least = true};
constexpr KeyRange k_factor{.least = 1e-6, .most = 1e6};
constexpr KeyRange between(double least, double most) {
  return {.least = least, .most = most};
}

constexpr std::string_view k_ring_sets =
    R"(camera.set = "half-dodecahedron" | "orbit" | "hemisphere")";
constexpr std::string_view k_spiral_sets = R"(camera.set = "orbit" | "hemisphere")";
constexpr std::string_view k_counted_sets = R"(camera.set = "orbit" | "hemisphere" | "random")";
/// The first key of the section that stands behind classes.
constexpr std::string_view k_behind_classes = "materials.dir";
constexpr std::string_view k_chosen_materials = R"(materials.assign != "own")";
constexpr std::string_view k_with_distractors = "distractors.dir != false";
constexpr std::string_view k_reinhard = R"(outputs.tone_map = "reinhard02")";

using enum KeyType;
using enum Moves;

/// But those of classes, and what cameras and checks add.
constexpr std::array k_own_keys = {
    KeySpec{"dataset.name", manifest, name, "", "(the recipe's file name less .toml)", k_any, "",
            "", "Names the dataset and its folder under out/"},
    KeySpec{"dataset.seed", images, integer, "", "0", at_least(0), "", "",
            "Changes every random choice, every split by hash and the noise of every image"},
    KeySpec{"dataset.licence", manifest, text, "", "\"\"", k_any, "", "",
            "Licence of the pictures, copied into the manifest"},
    KeySpec{"dataset.unlicensed", manifest, choice, "", "\"keep\"", k_any, R"("keep" | "error")",
            "",
            "Models, materials and environments with no licence beside them (LICENSE, COPYING, "
            "...: see "
            "Licences and sources): build with them, and say so in exports, or fail"},
    KeySpec{
        "dataset.unsourced", manifest, choice, "", "\"keep\"", k_any, R"("keep" | "error")", "",
        "Likewise of those with no source beside them: a SOURCE file that says whence they are"},
    KeySpec{"dataset.description", manifest, text, "", "\"\"", k_any, "", "",
            "What it is, for the manifest and what exports say of it, as the next five"},
    KeySpec{"dataset.creator", manifest, text, "", "\"\"", k_any, "", "", "Who made it"},
    KeySpec{"dataset.url", manifest, text, "", "\"\"", k_any, "", "", "Where it is to be found"},
    KeySpec{"dataset.published", manifest, text, "", "\"\"", k_any, "", "",
            "Day of publication, as \"2026-11-27\". Never taken from a clock"},
    KeySpec{"dataset.version", manifest, text, "", "\"\"", k_any, "", "", "Its version, as 1.2.0"},
    KeySpec{"dataset.cite", manifest, text, "", "\"\"", k_any, "", "",
            "How to cite it, as a sentence or BibTeX"},

    KeySpec{
        "models.dir", images, path, "", "", k_any, "", "",
        "Folder of models: its {mesh endings} files. Either this or models.files must be given; "
        "with --set, the one given replaces the other"},
    KeySpec{"models.files", images, path_list, "", "", k_any, "", "",
            "Model files, of any name. No two models may have one name"},
    KeySpec{"models.recursive", images, boolean, "", "false", k_any, "", "",
            "Look into the folders inside models.dir too"},
    KeySpec{"models.names", images, choice, "", "\"file\"", k_any, R"("file" | "path")", "",
            "What a model is called: its file's name, or its path in models.dir (of models.files "
            "as it is "
            "written, less leading ..), which tells chair/model.obj from mug/model.obj"},
    KeySpec{"models.up", scene, choice, "", "\"y\"", k_any, R"("y" | "z")", "",
            "The models' upward axis. \"y\" turns them by 90 degrees about x, so that Z is up; "
            "\"z\" leaves them"},
    KeySpec{"models.size_m", scene, number, "m", "0.16", between(0, k_far_m), "", "",
            "Longest side of the bounding box after scaling, before turn; 0 keeps the size. Drawn "
            "once a model where its distribution does not say per = \"view\""},
    KeySpec{
        "models.turn",
        scene,
        quaternion,
        "",
        "\"none\"",
        {-1, 1},
        "\"none\"",
        "",
        "Turns the model, whose size stays: a quaternion w, x, y, z, of which the length does "
        "not count, or a distribution: { rotation = \"up\" } about the vertical, \"any\" evenly "
        "over all rotations. models.ground_z_m puts what has been turned on the ground"},
    KeySpec{"models.place_m", scene, point, "m", "[0, 0, 0]", k_coordinate, "", "",
            "Moves the model, which models.centre and models.ground_z_m placed; the third number "
            "lifts it off the ground"},
    KeySpec{"models.ground_z_m", scene, number, "m", "-0.0574", k_coordinate, "false", "",
            "The least z after moving; false leaves the height"},
    KeySpec{"models.centre", scene, choice, "", "\"mass\"", k_any, R"("mass" | "box" | "none")", "",
            "What is moved to x = y = 0: the surface's centre of mass, the middle of the bounding "
            "box, or nothing"},
    KeySpec{
        "models.normals", film, choice, "", "\"smooth\"", k_any, R"("smooth" | "keep" | "flat")",
        "",
        "Vertex normals: weighted by area and angle and split at creases; the file's, which must "
        "have some; or one a face"},
    KeySpec{"models.crease_deg", film, number, "degree", "60", between(0, 180), "",
            R"(models.normals = "smooth")",
            "Faces that meet at a larger angle keep an edge; 180 smooths every edge"},

    KeySpec{"materials.dir", images, path, "", "", k_any, "", k_chosen_materials,
            "Folder of materials: its .mat files. Either this or materials.files must be given; "
            "with --set, the one given replaces the other"},
    KeySpec{"materials.files", images, path_list, "", "", k_any, "", k_chosen_materials,
            "Material files, of any name; a material's name is its file name less the ending"},
    KeySpec{"materials.assign", images, choice, "", "\"random\"", k_any,
            R"("random" | "cycle" | "all" | "balanced" | "own")", "",
            "Which material an image shows: one by chance, one view after the other, an image for "
            "each, or by chance but each equally often in each class of each split. \"own\": those "
            "that each model's file gives its faces; see Models' own materials"},
    KeySpec{"materials.per", images, choice, "", "\"model\"", k_any, R"("model" | "view")",
            R"(materials.assign = "random" | "balanced")",
            "Whether chance chooses once for all views of a model, or anew for each view"},
    KeySpec{"materials.vary", film, patterns, "", "{}", k_any, "", k_chosen_materials,
            "What is drawn of the material that an image's model shows (distractors' stay as they "
            "are): by NAME.PROPERTY of its file, a distribution or a constant; see Distributions"},

    KeySpec{
        "distractors.dir", scene, path, "", "false", k_any, R"(false | "{models}")", "",
        "Shows further models beside an image's own: those of this folder, found as models.dir's "
        "are, or \"{models}\": the recipe's own, of the image's split and fold alone. false: "
        "none. See Distractors"},
    KeySpec{"distractors.count", scene, integer, "", "1", between(0, k_most_distractors), "",
            k_with_distractors, "How many; one that finds no place is left out, and counted"},
    KeySpec{
        "distractors.place_m", scene, point, "m", "", k_coordinate, "", k_with_distractors,
        "Where each is moved to, as models.place_m: a distribution, which must be given. A place "
        "is drawn again where the distractor would touch something"},
    KeySpec{"distractors.size_m", scene, number, "m", "0.1", between(0, k_far_m), "",
            k_with_distractors, "Their longest side, as models.size_m; drawn for each"},
    KeySpec{"distractors.turn", scene, quaternion, "", "\"none\"", between(-1, 1), "\"none\"",
            k_with_distractors, "Turns each, as models.turn"},
    KeySpec{"distractors.vary", film, patterns, "", "{}", k_any, "", k_with_distractors,
            "What is drawn of the material of each, as materials.vary, which is of models alone"},
    KeySpec{"distractors.gap_m", scene, number, "m", "0.005", between(0, k_far_m), "",
            k_with_distractors,
            "Least distance between upright cylinders around the boxes of two models, and of the "
            "camera from a distractor's"},
    KeySpec{"distractors.tries", scene, integer, "", "64", between(1, 10000), "",
            k_with_distractors, "Most draws of a distractor's place"},
    KeySpec{"distractors.own", scene, boolean, "", "false", k_any, "", k_with_distractors,
            "Whether an image's own model, or another file of its mesh, may be a distractor, too"},
    KeySpec{"distractors.class", manifest, text, "", "\"\"", k_any, "",
            R"(distractors.dir != false | "{models}")",
            "Class path of distractors that are not the recipe's own models; \"\": none, and then "
            "exports do not list them"},

    KeySpec{"environments.dir", images, path, "", "", k_any, "", "",
            "Folder of environments: the folders in it that hold an environment.scn. Either this "
            "or environments.files must be given; with --set, the one given replaces the other"},
    KeySpec{"environments.files", images, path_list, "", "", k_any, "", "",
            "Environment folders; an environment's name is its folder's"},
    KeySpec{"environments.assign", images, choice, "", "\"cycle\"", k_any,
            R"("cycle" | "random" | "all" | "balanced")", "",
            "Which environment an image shows, as materials.assign"},
    KeySpec{"environments.per", images, choice, "", "\"view\"", k_any, R"("view" | "model")",
            R"(environments.assign = "random" | "balanced")", "As materials.per"},
    KeySpec{"environments.turn_deg", scene, number, "degree", "0", between(-360, 360), "", "",
            "Turns the environment about the vertical through the origin, its lights too: "
            "counter-clockwise seen from above"},
    KeySpec{"environments.gain", film, number, "", "1", k_factor, "", "",
            "Factor on all light of the environment"},
    KeySpec{"environments.temperature_k", film, number, "K", "false", between(1700, 25000), "false",
            "",
            "Multiplies all light of the environment by the colour of a black body of this "
            "temperature, of luminance 1: 3000 is warm, 6500 nearly as it is, 10000 bluish. false: "
            "as it is"},
    KeySpec{"environments.vary", film, patterns, "", "{}", k_any, "", "",
            "What is drawn of its lights, materials and textures: by NAME.PROPERTY of its scene "
            "file, or ENVIRONMENT/NAME.PROPERTY; a distribution or a constant, as materials.vary"},
    KeySpec{"lights", scene, lights, "", "[]", k_any, "", "",
            "Lights beside the environment's, each a table [[lights]] of what stands below; see "
            "Lights"},

    KeySpec{"camera.set", images, choice, "", "\"half-dodecahedron\"", k_any,
            R"("half-dodecahedron" | "list" | "orbit" | "hemisphere" | "random")", "",
            "Where the cameras stand: see Cameras in recipes/README.md"},
    KeySpec{"camera.distance_m", scene, number, "m", "0.252", k_distance, "\"fit\"", k_ring_sets,
            "Distance from camera.target. \"fit\": for each model and view the least at which the "
            "model's bounding sphere is in the picture: see Cameras in recipes/README.md"},
    KeySpec{"camera.fit_margin", scene, number, "", "0.05", between(0, 0.9), "",
            R"(camera.distance_m = "fit")",
            "Share of the way from the picture's middle to each edge that stays free around the "
            "sphere"},
    KeySpec{
        "camera.normalise", scene, boolean, "", "true", k_any, "",
        R"(camera.set = "half-dodecahedron")",
        "true: every camera at distance_m; false: the table's vectors times distance_m / 1.732"},
    KeySpec{"camera.positions", images, point_list, "m", "", k_coordinate, "",
            R"(camera.set = "list")", "Camera positions in the world"},
    KeySpec{"camera.position_m", scene, point, "m", "", k_coordinate, "",
            R"(camera.set = "random")",
            "Where the camera stands, from camera.target: a distribution, which must be given with "
            "set = \"random\""},
    KeySpec{"camera.count", images, integer, "", "12", between(1, 100000), "", k_counted_sets,
            "Number of views"},
    KeySpec{"camera.elevation_deg", scene, number, "degree", "30", between(-90, 90), "",
            R"(camera.set = "orbit")",
            "Height of the circle above the horizon, seen from the target"},
    KeySpec{"camera.azimuth_deg", scene, number, "degree", "0", between(-360, 360), "",
            k_spiral_sets, "Azimuth of view 0, counter-clockwise from +X seen from above"},
    KeySpec{"camera.target", scene, point, "m", "[0, 0, 0]", k_coordinate, "", "",
            "The point every camera looks at"},
    KeySpec{"camera.roll_deg", scene, number, "degree", "0", between(-360, 360), "", "",
            "Turns the camera about its viewing axis: clockwise, seen from behind it, so that the "
            "picture turns counter-clockwise"},
    KeySpec{"camera.views", images, integer_list, "", "[]", k_any, "", "",
            "Use only these views of the set, by number from 0; the names stay. []: all"},
    KeySpec{"camera.type", scene, choice, "", "", k_any, "", "", ""},  // and a span: camera_keys
    KeySpec{"camera.lens_radius_m", film, number, "m", "0", between(0, k_far_m), "", "",
            "Radius of the thin lens; 0 is a pinhole, sharp everywhere"},
    KeySpec{"camera.focus", film, choice, "", "\"origin\"", k_any,
            R"("origin" | "target" | "distance")", "",
            "What is in focus: the plane through the origin, through the target, or at "
            "focus_distance_m"},
    KeySpec{"camera.focus_distance_m", film, number, "m", "", k_distance, "",
            R"(camera.focus = "distance")",
            "Distance of the plane in focus along the viewing axis; must be given with focus = "
            "\"distance\""},
    KeySpec{"camera.keep.in_frame", scene, number, "", "0", between(0, 1), "", "",
            "Least share of the model's projected area that must be inside the picture: else the "
            "view is drawn again, as with the next two; see Distributions"},
    KeySpec{"camera.keep.visible", scene, number, "", "0", between(0, 1), "", "",
            "Least share of the model that nothing may hide, of what of it is in the picture; told "
            "by 64 x 64 rays"},
    KeySpec{"camera.keep.clearance_m", scene, number, "m", "0", between(0, k_far_m), "", "",
            "Least distance of the camera, and of each of [[lights]] that stands somewhere, from "
            "model and environment. With any of the three above "
            "0 the camera must not be inside the model either"},
    KeySpec{"camera.keep.tries", images, integer, "", "64", between(1, 10000), "", "",
            "Most draws of an image until its view is kept; without one the image is an error of "
            "the plan"},

    KeySpec{"engine.width", scene, integer, "pixel", "512", between(1, 16384), "", "",
            "Width of the picture"},
    KeySpec{"engine.height", scene, integer, "pixel", "512", between(1, 16384), "", "",
            "Height of the picture"},
    KeySpec{"engine.spp", film, integer, "", "64", between(1, 1 << 24), "", "engine.error = false",
            "Samples a pixel"},
    KeySpec{"engine.error",
            film,
            number,
            "",
            "false",
            {1e-6, 1},
            "false",
            "",
            "Instead of spp: add samples where they are needed until the developed picture's "
            "relative error is below this with 97.5 % confidence: see How exact a picture is in "
            "recipes/README.md"},
    KeySpec{"engine.max_spp", film, integer, "", "1024", between(16, 1 << 24), "",
            "engine.error != false",
            "Most samples a pixel, on the picture's average, to reach engine.error with; a picture "
            "that needs more is made with these and listed at the end of the build"},
    KeySpec{"engine.error_region", film, choice, "", "\"image\"", k_any, R"("image" | "model")",
            "engine.error != false",
            "Which pixels engine.error is of: all, or those where the mask shows the model; others "
            "then get 16 samples"},
    KeySpec{"engine.keep_sums", manifest, boolean, "", "false", k_any, "", "",
            "Keep each film's sums in the store, 176 bytes a pixel: more spp, or a smaller error, "
            "then traces the missing samples only"},
    KeySpec{"engine.depth_total", film, integer, "", "6", between(1, 255), "", "",
            "Longest path: vertices after the camera"},
    KeySpec{"engine.depth_diffuse", film, integer, "", "4", between(0, 255), "", "",
            "Most diffuse bounces of a path"},
    KeySpec{"engine.depth_glossy", film, integer, "", "4", between(0, 255), "", "",
            "Most glossy bounces of a path"},
    KeySpec{"engine.depth_specular", film, integer, "", "6", between(0, 255), "", "",
            "Most mirror and glass bounces of a path"},
    KeySpec{"engine.roulette_depth", film, integer, "", "3", between(0, 255), "", "",
            "First vertex at which Russian roulette may end a path"},
    KeySpec{"engine.roulette_cap", film, number, "", "0.5", between(0.001, 1), "", "",
            "Least probability that a path survives it"},
    KeySpec{"engine.filter_width", film, number, "pixel", "3", between(0, 16), "", "",
            "Full width of the Blackman-Harris pixel filter; up to 1 it is a box of one pixel"},
    KeySpec{"engine.math", film, choice, "", "\"strict\"", k_any, R"("strict" | "fast")", "",
            "\"strict\": the same bits on every device; \"fast\": for previews"},
    KeySpec{"engine.outlier_limit", film, number, "radiance", "0", between(0, 1e12), "", "",
            "Scale samples down whose greatest component (linear, before the tone map) is above "
            "this, which takes light away: see Samples that are not added in recipes/README.md. 0: "
            "no sample is touched"},
    KeySpec{"engine.rejected_limit", manifest, number, "", "0.001", between(0, 1), "", "",
            "Largest share of a picture's samples that may be NaN, infinite or negative; over it "
            "the picture fails"},

    KeySpec{
        "outputs.image", files, choice, "", "\"png\"", k_any, R"("png" | false)", "",
        "Format of the pictures: 8 bit RGB, images/MODEL/VIEW.png; false: none, and then no path "
        "is traced"},
    KeySpec{"outputs.mask", files, boolean, "", "true", k_any, "", "",
            "Write VIEW.mask.png: white where the model is seen, else black"},
    KeySpec{"outputs.depth", files, choice, "", "false", k_any, R"("exr" | false)", "",
            "Write VIEW.depth.exr: planar z in metres"},
    KeySpec{
        "outputs.planes", files, text_list, "", "[]", k_any, "", "",
        "Further planes, each a file VIEW.NAME.png or .exr: NAME, or NAME:ENCODING where not the "
        "usual one; see Planes"},
    KeySpec{
        "outputs.tone_map", files, choice, "", "\"environment\"", k_any,
        R"("environment" | "linear" | "reinhard02" | "autolinear")", "",
        "How radiance becomes 8 bits: as each environment's environment.cfg says (without one: "
        "autolinear, which gives every picture a factor of its own, and a gamma of 2.2), or this "
        "for all"},
    KeySpec{"outputs.tone_map_scale", files, number, "", "1", k_factor, "",
            R"(outputs.tone_map = "linear")", "Factor on the radiance"},
    KeySpec{"outputs.tone_map_prescale", files, number, "", "1", k_factor, "", k_reinhard,
            "Factor before the curve"},
    KeySpec{"outputs.tone_map_postscale", files, number, "", "1.2", k_factor, "", k_reinhard,
            "Factor behind the curve"},
    KeySpec{"outputs.tone_map_burn", files, number, "", "3.75", k_factor, "", k_reinhard,
            "Where highlights burn out"},
    KeySpec{"outputs.tone_map_gamma", files, number, "", "2.2", between(0.1, 10), "",
            R"(outputs.tone_map = "linear" | "reinhard02" | "autolinear")",
            "Pictures hold radiance^(1/gamma)"},
    KeySpec{"outputs.camera.exposure_ev", files, number, "EV", "0", between(-20, 20), "", "",
            "Exposure of the picture, on top of its tone map: a factor of 2^exposure_ev. This and "
            "the "
            "next four are done to pictures behind the film, in this order, and to nothing else"},
    KeySpec{"outputs.camera.vignetting", files, number, "", "0", between(0, 1), "", "",
            "Share of the light that the picture's corners lose; it grows with the square of the "
            "distance from the middle"},
    KeySpec{"outputs.camera.blur_px", files, number, "pixel", "0", between(0, 64), "", "",
            "Deviation of a Gaussian blur, in linear light"},
    KeySpec{"outputs.camera.noise", files, number, "", "0", between(0, 1), "", "",
            "Sensor noise: its deviation at white (1 under the tone map). Variance noise^2 (v + "
            "0.01) "
            "at v: shot noise, and what is read out in the dark"},
    KeySpec{"outputs.camera.jpeg_quality", files, integer, "", "false", between(1, 100), "false",
            "",
            "The picture is what a JPEG of this quality leaves of it, stored without further loss"},
    KeySpec{"outputs.keep_film", manifest, boolean, "", "true", k_any, "", "",
            "Keep the traced film in the store, so that another tone map needs no tracing; costs "
            "12 bytes a pixel before compression"},
};

/// camera.type, and the keys in which its types' spans are given.
struct CameraKeys {
  std::string types, default_type, help;
  struct Span {
    const CameraType* first = nullptr;
    std::string name, only_with;
  };
  std::vector<Span> spans;
};

CameraKeys make_camera_keys() {
  CameraKeys keys;
  for (const CameraType& type : camera_types()) {
    const std::string literal = fmt::format("\"{}\"", type.name);
    const auto add = [&](std::string& list) { list += (list.empty() ? "" : " | ") + literal; };
    add(keys.types);
    // A sentence that ends as helps do, without a full stop.
    if (!keys.help.empty()) keys.help += ". ";
    std::string comment = header_comment("cameras", type.name);
    comment.pop_back();
    keys.help += fmt::format("{}: {}", literal, comment);
    const std::string name = fmt::format("camera.{}", type.span_name());
    auto span = std::find_if(keys.spans.begin(), keys.spans.end(),
                             [&](const CameraKeys::Span& one) { return one.name == name; });
    if (span == keys.spans.end())
      span = keys.spans.insert(span, {&type, name, "camera.type = " + literal});
    else
      span->only_with += " | " + literal;
  }
  keys.default_type = keys.types.substr(0, keys.types.find(" | "));
  return keys;
}

/// Names and defaults of the checks' thresholds.
struct CheckKeys {
  std::string name, default_value;
  const Threshold* threshold;
};

std::vector<CheckKeys> make_check_keys() {
  std::vector<CheckKeys> keys;
  for (const Check& check : checks())
    for (const Threshold& threshold : check.thresholds)
      keys.push_back({fmt::format("check.{}", threshold.name),
                      fmt::format("{}", threshold.standard), &threshold});
  return keys;
}

std::vector<KeySpec> make_keys() {
  static const CameraKeys cameras = make_camera_keys();
  std::vector<KeySpec> keys;
  for (KeySpec key : k_own_keys) {
    const bool is_type = key.name == "camera.type";
    if (key.name == k_behind_classes)
      keys.insert(keys.end(), class_keys().begin(), class_keys().end());
    if (is_type) {
      key.default_value = cameras.default_type;
      key.choices = cameras.types;
      key.help = cameras.help;
    }
    keys.push_back(key);
    if (!is_type) continue;
    for (const CameraKeys::Span& span : cameras.spans) {
      const kernels::CameraOnHost& host = span.first->host;
      keys.push_back({span.name, scene, number,
                      host.span == kernels::CameraSpan::fov_deg ? "degree" : "m",
                      host.default_value, host.range, "", span.only_with, host.help});
    }
  }
  static const std::vector<CheckKeys> of_checks = make_check_keys();
  for (const CheckKeys& key : of_checks)
    keys.push_back({key.name, manifest, number, "", key.default_value, key.threshold->range, "", "",
                    key.threshold->help});
  return keys;
}

const std::vector<KeySpec>& all_keys() {
  static const std::vector<KeySpec> keys = make_keys();
  return keys;
}

}  // namespace

std::span<const KeySpec> recipe_keys() {
  return all_keys();
}

const KeySpec* find_key(std::string_view name) {
  const std::vector<KeySpec>& keys = all_keys();
  const auto at =
      std::find_if(keys.begin(), keys.end(), [&](const KeySpec& key) { return key.name == name; });
  return at == keys.end() ? nullptr : &*at;
}

}  // namespace ds
