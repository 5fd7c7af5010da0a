# setup.sh - finds the source, installs missing packages and builds, for run.sh and test.sh.
# Bash scripts source this file. It sets ROOT, the source folder.
# SPDX-License-Identifier: MIT

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# The names are Debian 12's. The tests use xvfb, xauth and openscenegraph (osgviewer, osgconv, the examples), and
# write files by OpenVDB, whose headers need boost. "osgraytracebench report" uses gnuplot, and videos are made by
# ffmpeg. The tests of form use clang-format of this version and doxygen.
PACKAGES=(build-essential cmake ninja-build
          libopenscenegraph-dev libembree-dev libtbb-dev libglm-dev libopenexr-dev libpng-dev libjpeg-dev
          libgl-dev libegl-dev libosmesa6-dev libgl1-mesa-dri
          libdraco-dev libmeshoptimizer-dev libwebp-dev libopenmpi-dev openmpi-bin libzmq3-dev
          zlib1g-dev libblosc-dev libopenvdb-dev libboost-dev
          pybind11-dev python3-dev python3-numpy
          libcli11-dev nlohmann-json3-dev catch2 openscenegraph xvfb xauth
          gnuplot-nox ffmpeg clang-format-14 doxygen graphviz)

say() { printf '%s\n' "$*" >&2; }

# Installs the packages that are missing, as root or with sudo; otherwise names them and ends with 1.
install_packages()
{
    if ! command -v dpkg-query >/dev/null; then
        say "No Debian package manager here. Needed, by their Debian names: ${PACKAGES[*]}"
        return 0
    fi
    local package missing=() as_root=()
    for package in "${PACKAGES[@]}"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0

    if [ "$(id -u)" -ne 0 ]; then
        # Without a terminal sudo must not ask for a password.
        if ! command -v sudo >/dev/null || { [ ! -t 0 ] && ! sudo -n true 2>/dev/null; }; then
            say "These packages are missing, and only root can install them:"
            say "  apt-get install ${missing[*]}"
            exit 1
        fi
        as_root=(sudo)
    fi
    say "Installing ${missing[*]}"
    "${as_root[@]}" apt-get -qq update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -qq install -y --no-install-recommends "${missing[@]}" >&2
}

# build PRESET [TARGET ...] configures and builds; it builds everything if no target is given.
build()
{
    local preset=$1
    shift
    if command -v ccache >/dev/null; then
        export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER:-ccache}
        # What one checkout compiled serves another, and files with precompiled headers are cached, too.
        export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$ROOT} CCACHE_NOHASHDIR=${CCACHE_NOHASHDIR:-1}
        export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}
    fi
    (cd "$ROOT" && cmake --preset "$preset" >/dev/null &&
        cmake --build --preset "$preset" ${1:+--target "$@"}) >&2
}
