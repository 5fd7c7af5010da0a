// ConversionReport.h - counts of what a conversion met, where, and its warnings. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// Counts by "<class>.<reason>" as Statistics::conversion shows them: see ReportReasons.h.
using ConversionCounts = std::map<std::string, uint64_t>;

inline void addCounts(ConversionCounts& sum, const ConversionCounts& more)
{
    for (const auto& [what, count] : more)
        sum[what] += count;
}

/// By the same keys: node paths of the first few objects.
using ConversionPaths = std::map<std::string, std::vector<std::string>>;

constexpr std::size_t kPathsKept = 4;

/// Counts and warns about bad data: once for each object and reason, as long as the process lives.
class ConversionReport
{
public:
    using Place = std::function<std::string()>;

    /// Where what is counted from now on is found: asked for the first few of each reason only, so
    /// it may be slow. Empty: nowhere. What it refers to must live until the next call.
    void setPlace(Place place) { _place = std::move(place); }

    void count(const std::string& what, uint64_t number = 1);
    void add(const ConversionCounts& counts);
    void add(const ConversionReport& other); ///< with its paths

    /// Counts one skipped or changed object and names it: "transform 'root/arm': singular,
    /// skipped".
    void warn(const std::string& what, const std::string& object, const std::string& message);

    /// Counts a file that could not be read, and names it: "texture wall.png: the file cannot be
    /// read, " and what stands for it.
    void missing(const std::string& what, const std::string& file, const std::string& object,
                 const std::string& instead);

    /// Adds the counts of what belongs to the present place, with the files that are missing for
    /// it.
    void addHere(const ConversionReport& other);

    const ConversionCounts& counts() const { return _counts; }

    /// Times that something was counted but what was converted.
    uint64_t remarks() const { return _remarks; }
    const ConversionPaths& paths() const { return _paths; }

    /// True if warn has said it, with a line of each object.
    bool isNamed(const std::string& what) const { return _named.count(what) > 0; }

private:
    void recordPath(const std::string& what, const std::string& path);

    ConversionCounts _counts;
    ConversionPaths _paths;
    uint64_t _remarks = 0;
    std::set<std::string> _named;
    Place _place;
};

/// Says what was left out of a geometry, in one line for each reason.
void warnAboutGeometry(const std::string& path, const ConversionCounts& counts);

/// Names each reason why something does not look as OpenGL shows it, once in the life of the
/// process, with the first object; those that are named object by object are left out.
/// rasterizesRest: what is not traced is drawn by OSG, and not worth a warning.
void warnOnceAReason(const ConversionReport& report, bool rasterizesRest);

} // namespace osgRayTrace::engine
