// DrawnParts.cpp - counts what is left to OSG. Layer: apps.
// SPDX-License-Identifier: MIT
#include "DrawnParts.h"

#include "osgRayTrace/bridge/common/ReportReasons.h"

namespace osgRayTrace::app
{

namespace
{

/// Returns whether OSG draws nothing of such a part either.
bool isUnseen(const std::string& what)
{
    return what == "not-traced.clipped-away" || what == "not-traced.no-vertices" ||
           what == "not-traced.billboard-child";
}

std::string meaningOf(const std::string& what)
{
    for (const engine::ReportReason& reason : engine::kReportReasons)
        if (what == reason.key) return reason.meaning;
    return what;
}

} // namespace

std::map<std::string, uint64_t> drawnParts(const Statistics& statistics)
{
    std::map<std::string, uint64_t> parts;
    for (const auto& [what, count] : statistics.conversion)
    {
        const bool left = what.rfind("rasterized.", 0) == 0 || what.rfind("not-traced.", 0) == 0;
        if (left && count > 0 && !isUnseen(what)) parts[what] = count;
    }
    return parts;
}

uint64_t partsDrawnByOsg(const Statistics& statistics)
{
    uint64_t parts = 0;
    for (const auto& [what, count] : drawnParts(statistics))
        parts += count;
    return parts;
}

bool isTraced(const Statistics& statistics)
{
    return statistics.triangles > 0 || statistics.conversion.count("converted.volume") > 0;
}

std::string inWords(const std::map<std::string, uint64_t>& counts)
{
    std::string text;
    for (const auto& [what, count] : counts)
        text += (text.empty() ? "" : ", ") + meaningOf(what) + " (" + std::to_string(count) + ")";
    return text;
}

} // namespace osgRayTrace::app
