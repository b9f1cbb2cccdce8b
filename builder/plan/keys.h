// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "builder/plan/inputs.h"
#include "builder/plan/output_kinds.h"
#include "builder/plan/texts.h"
#include "builder/recipe/recipe.h"

#include <memory>
#include <string>
#include <vector>

namespace ds {

/// One file of an image, and the key of what it is made from.
struct OutputFile {
  std::string kind;  ///< "image", or the plane's name
  std::string path;  ///< relative to the dataset's folder: "images/human.ply/0.mask.png"
  Hash128 key;
  const PlaneType* plane = nullptr;  ///< none: the picture
};

/// The keys of one image: one for each stage, so that a change costs only the stages after it.
///   render    what is traced: hash of the five parts
///   kept      of a film under way: render less spp, error and max_spp
///   outputs   each file: its encoding, and of the picture render key and tone map; of a plane what it
///             is traced from: its program, model, normalisation and the environment's meshes with
///             what of normals, uvs and ids it reads, camera less its lens, size
struct ImageKeys {
  PartHashes parts;  ///< of folded texts; the sixth, "files", is not in `render`
  Hash128 render;
  /// Of the film's sums: as render, less what only says when to stop. Zero where no film is kept or
  /// nothing of the image is made.
  Hash128 kept;
  Hash128 files;  ///< of all outputs
  std::vector<OutputFile> outputs;
};

/// ImageKeys::render of the parts.
Hash128 render_key(const PartHashes& parts);

/// Makes keys, and keeps the texts they are hashes of. What images of one kind share (the traced
/// program's text, canonical texts, their hashes) is made once a kind: 25,000 images take a
/// fraction of a second. Needs no OpenCL device. Everything it refers to must outlive it.
class KeyMaker {
 public:
  KeyMaker(const Recipe& recipe, Inputs& inputs, TextSet& texts);
  ~KeyMaker();

  /// All but `kept`. Throws where a file of the image cannot be read.
  ImageKeys keys(const ImageSpec& image);
  /// ImageKeys::kept: a hash of the whole program's text, so only for images that need it.
  Hash128 kept_key(const ImageSpec& image, const ImageKeys& keys);
  /// Puts the texts that the image's keys are hashes of into the set, for `explain`. Those of the image that
  /// keys() was asked for last are there already.
  void add_texts(const ImageSpec& image, const ImageKeys& keys);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// The tone map an image is developed with: the recipe's, else its environment's.
const ToneMap& tone_map_of(const Recipe& recipe, const Scene& environment);
const ToneMap& tone_map_of(const Recipe& recipe, const EnvironmentFacts& environment);

/// Canonical text of the model part: the mesh, with what its material reads of uvs and colours, and
/// the normalisation steps that are switched on; those of normals where `reads` has them.
std::string canonical_model(const MeshHashes& mesh, MeshExtras reads,
                            const NormaliseOptions& options);

}  // namespace ds
