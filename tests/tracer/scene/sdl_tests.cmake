ds_test(sdl_test
  SOURCES colour_temperature_test.cc compose_test.cc own_materials_test.cc vary_material_test.cc vary_nodes_test.cc vary_test.cc properties_test.cc sdl_errors_test.cc sdl_lights_test.cc sdl_math_test.cc sdl_physical_test.cc sdl_reference_test.cc sdl_test.cc sky_test.cc
    sun_test.cc
  LIBS ds_scene)
