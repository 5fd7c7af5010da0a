// Machine.cpp - asks the processor and the libraries. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Machine.h"

#include <embree3/rtcore.h>
#include <osg/Version>

#include <fstream>

namespace osgRayTrace::bench
{

namespace
{

std::string processor()
{
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
    {
        if (line.rfind("model name", 0) != 0) continue;
        const std::size_t colon = line.find(": ");
        if (colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

std::string instructionSet()
{
#if defined(__GNUC__) && defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) return "AVX-512";
    if (__builtin_cpu_supports("avx2")) return "AVX2";
    if (__builtin_cpu_supports("avx")) return "AVX";
    return "SSE2";
#else
    return "unknown";
#endif
}

} // namespace

std::map<std::string, std::string> describeMachine(int threads)
{
    return {{"cpu", processor()},
            {"threads", std::to_string(threads)},
            {"isa", instructionSet()},
            {"osgRayTrace", OSGRAYTRACE_VERSION_STRING},
            {"Embree", RTC_VERSION_STRING},
            {"Embree flags", "robust"},
            {"OpenSceneGraph", osgGetVersion()},
            {"compiler", __VERSION__}};
}

} // namespace osgRayTrace::bench
