# What some lights read besides their headers' inputs (sdl_lights.h).
file(GLOB light_files RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/lights/*.cc")
ds_library(ds_scene
  SOURCES canonical_scene.cc colour_temperature.cc compose.cc fresnel_presets.cc own_scene.cc properties.cc scene_check.cc scene_reads.cc sdl_files.cc sdl_film.cc sdl_images.cc sdl_lights.cc sdl_materials.cc
    sdl_names.cc sdl_node.cc sdl_objects.cc sdl_parameters.cc sdl_physical.cc sdl_prune.cc sdl_spare.cc sdl_textures.cc sdl_unused.cc sdl_values.cc sdl_warn.cc sky_model.cc spectrum.cc sun_model.cc texture_bounds.cc told_lights.cc type_tables.cc vary.cc vary_material.cc vary_nodes.cc ${light_files}
  LIBS ds_base ds_kernels ds_mesh)
