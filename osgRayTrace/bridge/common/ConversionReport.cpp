// ConversionReport.cpp - words the conversion's warnings. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ConversionReport.h"

#include "osgRayTrace/bridge/common/ReportReasons.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>
#include <iterator>

namespace osgRayTrace::engine
{

namespace
{

const char* const kMissing = "missing.";

/// Returns whether warnAboutGeometry names the first geometry of the reason.
bool isNamedByGeometry(const std::string& what)
{
    return std::any_of(std::begin(kReportReasons), std::end(kReportReasons),
                       [&what](const ReportReason& reason)
                       { return reason.warning && what == reason.key; });
}

/// Returns whether the objects are names in the user's own settings: each of these few is named.
bool isOfSettings(const std::string& what)
{
    return what == "warned.material-name" || what == "warned.material-value" ||
           what == "warned.light-size";
}

bool begins(const std::string& text, const char* with)
{
    return text.rfind(with, 0) == 0;
}

} // namespace

void ConversionReport::recordPath(const std::string& what, const std::string& path)
{
    std::vector<std::string>& paths = _paths[what];
    const bool isNew = std::find(paths.begin(), paths.end(), path) == paths.end();
    if (isNew && paths.size() < kPathsKept) paths.push_back(path);
}

void ConversionReport::count(const std::string& what, uint64_t number)
{
    _counts[what] += number;
    _remarks += !begins(what, "converted.");
    if (_listener) _listener(what, number);
    if (!_place || number == 0 || begins(what, kMissing)) return; // missing files are named instead
    const auto recorded = _paths.find(what);
    if (recorded == _paths.end() || recorded->second.size() < kPathsKept)
        recordPath(what, _place());
}

void ConversionReport::countFor(const std::string& what, const std::string& cause)
{
    ++_counts[what];
    ++_remarks;
    if (_listener) _listener(what, 1);
    const std::string beginning = _place ? cause + ", for " : cause;
    const std::vector<std::string>& paths = _paths[what];
    const bool isNamed =
        std::any_of(paths.begin(), paths.end(),
                    [&](const std::string& path) { return begins(path, beginning.c_str()); });
    if (!isNamed && paths.size() < kPathsKept)
        recordPath(what, _place ? beginning + _place() : cause);
}

void ConversionReport::add(const ConversionCounts& counts)
{
    for (const auto& [what, number] : counts)
        count(what, number);
}

void ConversionReport::add(const ConversionReport& other)
{
    add(other._counts);
    for (const auto& [what, paths] : other._paths)
        for (const std::string& path : paths)
            recordPath(what, path);
    _named.insert(other._named.begin(), other._named.end());
}

void ConversionReport::warn(const std::string& what, const std::string& object,
                            const std::string& message)
{
    count(what);
    _named.insert(what);
    if (!_place) recordPath(what, object);
    if (isOfSettings(what))
        warnOnce(object + ": " + message);
    else
        warnOfKind(what, object + ": " + message);
}

void ConversionReport::missing(const std::string& what, const std::string& file,
                               const std::string& object, const std::string& instead)
{
    count(what);
    _named.insert(what);
    recordPath(what, file);
    warnOfKind(what, object + " " + file + ": the file cannot be read, " + instead);
}

void ConversionReport::addHere(const ConversionReport& other)
{
    add(other._counts);
    for (const auto& [what, paths] : other._paths)
        for (const std::string& file : paths)
            if (begins(what, kMissing))
                recordPath(what, _place ? file + ", for " + _place() : file);
    _named.insert(other._named.begin(), other._named.end());
}

void warnAboutGeometry(const std::string& path, const ConversionCounts& counts)
{
    for (const ReportReason& reason : kReportReasons)
    {
        const auto found = reason.warning ? counts.find(reason.key) : counts.end();
        if (found == counts.end()) continue;
        warnOfKind(reason.key, "geometry '" + path + "': " + std::to_string(found->second) + " " +
                                   reason.warning);
    }
}

void warnOnceAReason(const ConversionReport& report, bool rasterizesRest)
{
    for (const auto& [what, number] : report.counts())
    {
        const bool differs = begins(what, "approximated.") || begins(what, "skipped.") ||
                             (begins(what, "not-traced.") && !rasterizesRest);
        if (!differs || isNamedByGeometry(what) || report.isNamed(what)) continue;
        const auto paths = report.paths().find(what);
        const bool placed = paths != report.paths().end() && !paths->second.empty();
        warnOnceFor(what, what + ": " + std::to_string(number) +
                              (placed ? ", the first is '" + paths->second.front() + "'" : ""));
    }
}

} // namespace osgRayTrace::engine
