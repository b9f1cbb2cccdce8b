ds_test(mesh_test
  SOURCES mesh_attributes_test.cc mesh_formats_test.cc mesh_hash_test.cc mesh_mend_test.cc mesh_normalise_test.cc mesh_normals_test.cc mesh_outward_test.cc mesh_read_test.cc mesh_shape_test.cc
    mesh_text_test.cc mesh_topology_test.cc mesh_triangulate_test.cc mesh_unlikely_test.cc gltf_reader_test.cc mtl_reader_test.cc obj_reader_test.cc off_reader_test.cc ply_broken_test.cc ply_reader_test.cc stl_reader_test.cc
  LIBS ds_mesh)
