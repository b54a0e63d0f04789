"""libsinge for Conan 2: the library, with polygons and named materials. The command is not part of it."""

import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Singe(ConanFile):
    name = "singe"
    description = "Burns cloth and paper: a thin shell that heats, chars, shrinks, wrinkles, tears and is eaten away"
    license = "MIT"
    topics = ("simulation", "cloth", "fire", "vfx")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}

    @property
    def root(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        text = load(self, os.path.join(self.root, "include", "singe", "base.h"))
        self.version = re.search(r'#define SINGE_VERSION "(.*)"', text).group(1)

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "include/*", "src/*", "scripts/packaging/cmake/*"):
            copy(self, pattern, self.root, self.export_sources_folder)

    def config_options(self):
        if self.settings.os == "Windows":
            del self.options.fPIC

    def configure(self):
        self.settings.rm_safe("compiler.libcxx")
        self.settings.rm_safe("compiler.cppstd")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for option in ("PROGRAM", "TESTS", "PYTHON"):
            toolchain.cache_variables[f"SINGE_{option}"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        system = ["m", "pthread"] if self.settings.os in ("Linux", "FreeBSD") else []
        self.cpp_info.set_property("cmake_file_name", "singe")
        self.cpp_info.components["core"].libs = ["singe"]
        self.cpp_info.components["core"].system_libs = system
        self.cpp_info.components["core"].set_property("cmake_target_name", "singe::singe")
        self.cpp_info.components["core"].set_property("pkg_config_name", "singe")
        self.cpp_info.components["input"].libs = ["singe_input"]
        self.cpp_info.components["input"].requires = ["core"]
        self.cpp_info.components["input"].set_property("cmake_target_name", "singe::input")
        self.cpp_info.components["input"].set_property("pkg_config_name", "singe-input")
