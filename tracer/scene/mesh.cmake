ds_library(ds_mesh
  SOURCES mesh_corners.cc mesh_hash.cc mesh_inside.cc mesh_mend.cc mesh_normalise.cc mesh_normals.cc mesh_outward.cc mesh_read.cc
    mesh_text.cc mesh_topology.cc mesh_triangulate.cc off_reader.cc ply_header.cc ply_layout.cc ply_reader.cc
  LIBS ds_base)
