// SPDX-License-Identifier: Apache-2.0
// What the host asks of a kind of material, texture or light: DS_TRAITS in its header names a sum of
// these, or 0. No program holds this file: a new trait makes nothing stale.
#pragma once

enum {
  // A material ...
  k_trait_lobes = 1,              ///< picks one of several lobes: its paths draw a number for it
  k_trait_casts_caustics = 2,     ///< gathers light: photons leave it
  k_trait_receives_caustics = 4,  ///< looks for what was gathered: guide.h
  k_trait_transmits = 512,        ///< has a value below the surface: lights there are asked as well
  // A texture reads ...
  k_trait_uv = 8,          ///< the mesh's uv, by a 2D mapping
  k_trait_position = 16,   ///< a point in space, by a 3D mapping
  k_trait_colors = 32,     ///< the mesh's colours
  k_trait_chooses = 1024,  ///< nothing else: it is texture1 here and texture2 there
  // A light ...
  k_trait_beyond = 64,  ///< lies beyond the scene: paths that leave meet it (NAME_escape)
  k_trait_sampled =
      128,              ///< is chosen by next-event estimation; others, scattered rays find as well
  k_trait_small = 256,  ///< shines from few directions: what is gathered of it is small and bright
};
