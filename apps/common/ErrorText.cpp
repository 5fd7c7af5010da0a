// ErrorText.cpp - writes errors in percent. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ErrorText.h"

#include <cstdio>

namespace osgRayTrace::app
{

std::string errorText(double relativeError)
{
    if (!(relativeError < 0.995)) return "100 % or more, mostly noise";
    char text[32];
    std::snprintf(text, sizeof(text), "%.2g %%", 100.0 * relativeError);
    return text;
}

std::string estimateText(const Statistics& statistics)
{
    char share[80];
    std::snprintf(share, sizeof(share), "the worst 0.1 %% of the pixels hold %.0f %% of its square",
                  100.0 * statistics.worstErrorShare);
    return errorText(statistics.relativeError) + " (median tile " +
           errorText(statistics.medianError) + ", " + share + ")";
}

} // namespace osgRayTrace::app
