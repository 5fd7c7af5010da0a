# Finds what the Python module needs: pybind11, and a Python with its headers and numpy
# (OSGRAYTRACE_HAS_PYTHON). OSGRAYTRACE_PYTHON_DIR is where the module is installed, below the prefix or absolute.
# SPDX-License-Identifier: MIT

set(OSGRAYTRACE_HAS_PYTHON FALSE)
if(NOT OSGRAYTRACE_PYTHON)
    message(STATUS "Python module: left out, OSGRAYTRACE_PYTHON is off")
    return()
endif()

# The first Python of the path may lack numpy or headers that the system's has.
if(NOT Python_EXECUTABLE)
    foreach(candidate python3 /usr/bin/python3)
        execute_process(
            COMMAND "${candidate}" -c "import numpy, os, sys, sysconfig
print(sys.executable if os.path.exists(sysconfig.get_path('include') + '/Python.h') else '')"
            OUTPUT_VARIABLE found ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
        if(found)
            set(Python_EXECUTABLE "${found}" CACHE FILEPATH "Python that the module is built for")
            break()
        endif()
    endforeach()
endif()
set(PYBIND11_NOPYTHON ON) # its headers are wanted alone
find_package(pybind11 2.10 QUIET CONFIG)
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
if(NOT pybind11_FOUND OR NOT Python_FOUND)
    message(STATUS "Python module: left out; it needs pybind11, and Python with headers and numpy (Debian: "
        "pybind11-dev, python3-dev, python3-numpy; Python_EXECUTABLE names another Python)")
    return()
endif()
set(OSGRAYTRACE_HAS_PYTHON TRUE)

# A Python looks for modules below its own prefix only. If that is ours, its folder is taken, else the one that
# Pythons of other prefixes have; PYTHONPATH then names it.
execute_process(
    COMMAND "${Python_EXECUTABLE}" -c "import os, site, sys
prefix = sys.argv[1].rstrip('/') + '/'
inside = [p[len(prefix):] for p in site.getsitepackages() if p.startswith(prefix) and 'local/' not in p[len(prefix):]]
print(inside[0] if inside else 'lib/python%d.%d/site-packages' % sys.version_info[:2])" "${CMAKE_INSTALL_PREFIX}"
    OUTPUT_VARIABLE sitePackages OUTPUT_STRIP_TRAILING_WHITESPACE)
set(OSGRAYTRACE_PYTHON_DIR "${sitePackages}" CACHE STRING
    "Where the Python module is installed, below the prefix or absolute")
message(STATUS "Python module: for ${Python_EXECUTABLE}, version ${Python_VERSION}, into ${OSGRAYTRACE_PYTHON_DIR}")
