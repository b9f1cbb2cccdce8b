# Mesh formats, in the order in which they are asked whether a file is theirs: each is a NAME_reader.cc with a
# NAME_format (mesh_formats.h).
set(mesh_formats ply off stl obj)

set_property(GLOBAL PROPERTY ds_mesh_formats ${mesh_formats})
list(TRANSFORM mesh_formats APPEND _reader.cc OUTPUT_VARIABLE mesh_readers)
list(TRANSFORM mesh_formats APPEND _format OUTPUT_VARIABLE mesh_format_names)
list(JOIN mesh_format_names "," mesh_format_names)
set_source_files_properties(mesh_formats.cc PROPERTIES COMPILE_DEFINITIONS "DS_MESH_FORMATS=${mesh_format_names}")

ds_library(ds_mesh
  SOURCES mesh_corners.cc mesh_formats.cc mesh_hash.cc mesh_inside.cc mesh_mend.cc mesh_normalise.cc mesh_normals.cc mesh_outward.cc
    mesh_read.cc mesh_shape.cc mesh_text.cc mesh_topology.cc mesh_triangulate.cc ply_header.cc ply_layout.cc ${mesh_readers}
  LIBS ds_base)
