// Statistics.cpp - the conversion's counts as text. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/Statistics>

#include "osgRayTrace/bridge/common/ReportReasons.h"

#include <algorithm>

namespace osgRayTrace
{

using engine::kReportClasses;
using engine::ReportClass;

namespace
{

/// Turns "texture-size" into "texture size".
std::string words(std::string reason)
{
    std::replace(reason.begin(), reason.end(), '-', ' ');
    return reason;
}

std::string rightAligned(uint64_t count)
{
    const std::string digits = std::to_string(count);
    constexpr std::size_t kWidth = 10;
    return std::string(digits.size() < kWidth ? kWidth - digits.size() : 0, ' ') + digits;
}

/// Returns whether no class above claims a key.
bool isOther(const std::string& what)
{
    const auto claims = [&what](const ReportClass& c) { return what.rfind(c.prefix, 0) == 0; };
    return std::none_of(std::begin(kReportClasses), std::end(kReportClasses), claims);
}

std::string line(const Statistics& statistics, const std::string& what, const std::string& reason)
{
    const uint64_t count = statistics.conversion.at(what);
    std::string text = rightAligned(count) + "  " + words(reason) + '\n';
    const auto paths = statistics.conversionPaths.find(what);
    if (paths == statistics.conversionPaths.end()) return text;
    for (const std::string& path : paths->second)
        text += "              " + path + '\n';
    return text;
}

} // namespace

std::string conversionReport(const Statistics& statistics)
{
    std::string text;
    for (const ReportClass& c : kReportClasses)
    {
        std::string lines;
        const std::string prefix = c.prefix;
        for (const auto& [what, count] : statistics.conversion)
            if (count > 0 && what.rfind(prefix, 0) == 0)
                lines += line(statistics, what, what.substr(prefix.size()));
        if (!lines.empty()) text += std::string(c.title) + ":\n" + lines;
    }
    std::string others;
    for (const auto& [what, count] : statistics.conversion)
        if (count > 0 && isOther(what)) others += line(statistics, what, what);
    if (!others.empty()) text += "Other:\n" + others;
    if (text.empty()) return "Nothing was converted.\n";
    if (!statistics.lastConversionReason.empty())
    {
        text += "Converted as a whole " + std::to_string(statistics.conversions) +
                " times, for the last time because:\n            " +
                statistics.lastConversionReason + '\n';
        if (!statistics.lastConversionPath.empty())
            text += "              " + statistics.lastConversionPath + '\n';
    }
    return text;
}

} // namespace osgRayTrace
