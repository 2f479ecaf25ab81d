# Every third-party package, all from Debian 12. libsss/README.md says which file hides each.
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(TBB REQUIRED)
find_package(embree 3 REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(PNG REQUIRED)
find_package(hwy REQUIRED)

# OpenMesh and FLANN ship configurations that do not export usable targets everywhere.
find_path(OPENMESH_INCLUDE_DIR OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh REQUIRED)
find_library(OPENMESH_CORE_LIBRARY OpenMeshCore REQUIRED)
add_library(sss_openmesh INTERFACE)
target_include_directories(sss_openmesh SYSTEM INTERFACE ${OPENMESH_INCLUDE_DIR})
target_link_libraries(sss_openmesh INTERFACE ${OPENMESH_CORE_LIBRARY})

find_path(FLANN_INCLUDE_DIR flann/flann.hpp REQUIRED)
find_library(FLANN_CPP_LIBRARY flann_cpp REQUIRED)
find_library(LZ4_LIBRARY lz4 REQUIRED)
add_library(sss_flann INTERFACE)
target_include_directories(sss_flann SYSTEM INTERFACE ${FLANN_INCLUDE_DIR})
target_link_libraries(sss_flann INTERFACE ${FLANN_CPP_LIBRARY} ${LZ4_LIBRARY})

find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_library(XXHASH_LIBRARY xxhash REQUIRED)
add_library(sss_xxhash INTERFACE)
target_include_directories(sss_xxhash SYSTEM INTERFACE ${XXHASH_INCLUDE_DIR})
target_link_libraries(sss_xxhash INTERFACE ${XXHASH_LIBRARY})

find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
