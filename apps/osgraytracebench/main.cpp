// main.cpp - osgraytracebench MODE [--json FILE]. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/FeaturesMode.h"
#include "apps/osgraytracebench/LimitMode.h"

#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

using namespace osgRayTrace::bench;

namespace
{

struct Mode
{
    const char* name;
    const char* help;
    Rows (*measure)();
};

const Mode kModes[] = {
    {"limit", "a whole frame, a path traced one and a build against Embree alone", measureLimit},
    {"features", "what features cost a scene that does not use them", measureFeatures},
};

int usage()
{
    std::fprintf(stderr, "usage: osgraytracebench MODE [--json FILE]\n");
    for (const Mode& mode : kModes)
        std::fprintf(stderr, "  %-10s %s\n", mode.name, mode.help);
    return 1;
}

} // namespace

int main(int argc, char** argv)
{
    const bool json = argc == 4 && std::strcmp(argv[2], "--json") == 0;
    if (argc != 2 && !json) return usage();
    for (const Mode& mode : kModes)
    {
        if (std::strcmp(argv[1], mode.name) != 0) continue;
        try
        {
            const Rows rows = mode.measure();
            printRows(rows);
            if (json && !writeRows(rows, argv[3]))
            {
                std::fprintf(stderr, "osgraytracebench: cannot write %s\n", argv[3]);
                return 4;
            }
            return 0;
        }
        catch (const std::exception& error)
        {
            std::fprintf(stderr, "osgraytracebench: %s\n", error.what());
            return 3;
        }
    }
    return usage();
}
