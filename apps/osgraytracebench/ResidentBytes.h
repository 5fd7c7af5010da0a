// ResidentBytes.h - memory that the process holds. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <malloc.h>
#include <unistd.h>

#include <cstdio>

namespace osgRayTrace::bench
{

/// Returns the bytes that the process holds; freed memory is given back to the system first.
inline double residentBytes()
{
    malloc_trim(0);
    long total = 0, resident = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r"))
    {
        if (std::fscanf(file, "%ld %ld", &total, &resident) != 2) resident = 0;
        std::fclose(file);
    }
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

} // namespace osgRayTrace::bench
