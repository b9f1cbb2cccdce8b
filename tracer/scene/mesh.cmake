# Mesh formats, in the order in which they are asked whether a file is theirs: each is a NAME_reader.cc with a
# k_NAME_format (mesh_formats.h).
set(mesh_formats ply off stl obj gltf)

set_property(GLOBAL PROPERTY ds_mesh_formats ${mesh_formats})
list(TRANSFORM mesh_formats APPEND _reader.cc OUTPUT_VARIABLE mesh_readers)
list(TRANSFORM mesh_formats APPEND _format OUTPUT_VARIABLE mesh_format_names)
list(TRANSFORM mesh_format_names PREPEND k_)
list(JOIN mesh_format_names "," mesh_format_names)
set_source_files_properties(mesh_formats.cc PROPERTIES COMPILE_DEFINITIONS "DS_MESH_FORMATS=${mesh_format_names}")

# tinygltf is a header, of which gltf_file.cc holds the functions. It loads no image, and no file but by gltf_file.cc.
find_path(TINYGLTF_INCLUDE tiny_gltf.h REQUIRED)
set(tinygltf_definitions TINYGLTF_NO_FS TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE TINYGLTF_NO_EXTERNAL_IMAGE
  TINYGLTF_NO_INCLUDE_JSON)
set_source_files_properties(gltf_file.cc gltf_materials.cc gltf_reader.cc PROPERTIES COMPILE_DEFINITIONS "${tinygltf_definitions}"
  SKIP_UNITY_BUILD_INCLUSION ON)

ds_library(ds_mesh
  SOURCES gltf_file.cc gltf_materials.cc mesh_corners.cc mesh_formats.cc mesh_hash.cc mesh_inside.cc mesh_mend.cc mesh_normalise.cc mesh_normals.cc mesh_outward.cc
    mesh_read.cc mesh_shape.cc mesh_text.cc mesh_topology.cc mesh_triangulate.cc mtl_reader.cc own_materials.cc ply_header.cc ply_layout.cc sdl_math.cc ${mesh_readers}
  LIBS ds_base nlohmann_json::nlohmann_json)
