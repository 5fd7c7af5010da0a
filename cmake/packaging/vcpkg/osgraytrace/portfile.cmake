# A port of this source tree: vcpkg install osgraytrace --overlay-ports=cmake/packaging/vcpkg. Not tried.
# SPDX-License-Identifier: MIT
cmake_path(SET SOURCE_PATH NORMALIZE "${CMAKE_CURRENT_LIST_DIR}/../../../..")
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS -D OSGRAYTRACE_BUILD_TESTS=OFF -D OSGRAYTRACE_PYTHON=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME osgRayTrace CONFIG_PATH lib/cmake/osgRayTrace)
vcpkg_fixup_pkgconfig()
vcpkg_copy_tools(TOOL_NAMES osgraytrace osgraytraceviewer AUTO_CLEAN)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
