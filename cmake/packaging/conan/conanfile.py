# conanfile.py - a recipe of this source tree for Conan 2: conan create cmake/packaging/conan. Not tried.
# SPDX-License-Identifier: MIT
import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy


class OsgRayTrace(ConanFile):
    name = "osgraytrace"
    version = "0.1.0"
    license = "MIT"
    description = "Ray tracing node kit for OpenSceneGraph"
    package_type = "shared-library"
    settings = "os", "compiler", "build_type", "arch"
    generators = "CMakeDeps"
    requires = ("openscenegraph/3.6.5", "embree/4.3.3", "onetbb/2021.12.0", "glm/1.0.1", "openexr/3.2.4",
                "libpng/1.6.43", "libjpeg/9f", "cli11/2.4.2", "nlohmann_json/3.11.3")

    def export_sources(self):
        source = os.path.join(self.recipe_folder, os.pardir, os.pardir, os.pardir)
        for folder in ("apps", "cmake", "data", "osgPlugins", "osgRayTrace", "tests"):
            copy(self, f"{folder}/*", source, self.export_sources_folder)
        for file in ("CMakeLists.txt", "LICENSE", "*.md"):
            copy(self, file, source, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["OSGRAYTRACE_BUILD_TESTS"] = False
        toolchain.cache_variables["OSGRAYTRACE_PYTHON"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")  # the package has its own file for CMake
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "osgRayTrace"))
