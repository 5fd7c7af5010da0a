#!/usr/bin/env bash
# test.sh [release|asan|tsan ...] builds osgRayTrace and runs the test suite of the presets that are named, or
# of all three if none is. Everything runs in release. Tests of parts, of OpenGL, of the programs and with random
# input run again under AddressSanitizer and UBSan, and those of the threads of the engine and of the drawable
# under ThreadSanitizer (tests/RaceSuppressions.txt names what that does not see of OSG).
# CXX=clang++ builds with Clang, in a fresh clone; GCC is the default.
# OSGRAYTRACE_FUZZ_SEEDS=<number> takes that many random inputs.
# Sample models of OpenSceneGraph are found by OSG_FILE_PATH, or in a folder openscenegraph-data beside
# or near the source; those of glTF by OSGRAYTRACE_GLTF_MODELS, or in a folder gltf-data beside the source. Tests
# that need them are skipped without.
# SPDX-License-Identifier: MIT
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

[ $# -gt 0 ] || set -- release asan tsan
for preset in "$@"; do
    case $preset in
    release | asan | tsan) ;;
    *)
        say "There are no tests of a preset '$preset'; there are those of release, asan and tsan."
        exit 2
        ;;
    esac
done

PACKAGES+=(chromium) # A test opens the report's page in it.
case ${CXX:-} in *clang*) PACKAGES+=(clang libclang-rt-14-dev) ;; esac
install_packages

for folder in "$ROOT/../openscenegraph-data" "$ROOT/../shared/data/openscenegraph-data"; do
    if [ -z "${OSG_FILE_PATH:-}" ] && [ -d "$folder" ]; then
        OSG_FILE_PATH=$(cd "$folder" && pwd)
    fi
done
export OSG_FILE_PATH=${OSG_FILE_PATH:-}
for folder in "$ROOT/../gltf-data" "$ROOT/../shared/data/gltf"; do
    if [ -z "${OSGRAYTRACE_GLTF_MODELS:-}" ] && [ -d "$folder" ]; then
        OSGRAYTRACE_GLTF_MODELS=$(cd "$folder" && pwd)
    fi
done
export OSGRAYTRACE_GLTF_MODELS=${OSGRAYTRACE_GLTF_MODELS:-}
say "Sample models: ${OSG_FILE_PATH:-none, tests that need them are skipped}"
say "glTF sample models: ${OSGRAYTRACE_GLTF_MODELS:-none, the test that needs them is skipped}"

# check PRESET [CTEST ARGUMENT ...] runs the tests of a preset.
check()
{
    local preset=$1
    shift
    say "Testing $preset"
    (cd "$ROOT" && ctest --preset "$preset" --parallel "$(nproc)" "$@")
}

for preset in "$@"; do
    case $preset in
    release)
        build release
        check release
        ;;
    asan)
        build asan sanitized
        check asan -L 'unit|gl|fuzz'
        ;;
    tsan)
        build tsan baseTest groupTest serversTest sessionTest displayTest viewsTest backgroundTracerTest backgroundTest
        check tsan -R '^(base|group|servers|session|display|views|backgroundTracer|background)Test$'
        ;;
    esac
done
