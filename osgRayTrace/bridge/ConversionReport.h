// ConversionReport.h - counts of what a conversion met, and its warnings. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace osgRayTrace::engine
{

/// Counts by "<class>.<reason>" as Statistics::conversion shows them:
/// converted    what became part of the Scene: geometry (drawables), instance, material, texture, light
/// repaired     values that were replaced: normal, texture-coordinate, color (each a vertex),
///              environment-not-finite, -negative, -too-bright (each a pixel)
/// skipped      bad data left out: index-out-of-range, not-finite, degenerate (each a triangle);
///              everything else an object
/// warned       things that are traced as they are, but look wrong: far-vertices (a drawable),
///              opposite-normals (a triangle)
/// approximated things that are traced, but not with all that OpenGL would do (a drawable or an object)
/// not-traced   things that have no triangles, or that are not part of the scene as seen by a ray; OSG draws
///              them where there is a viewer
/// rasterized   things that have triangles and that OSG draws all the same, in a viewer
using ConversionCounts = std::map<std::string, uint64_t>;

inline void addCounts(ConversionCounts& sum, const ConversionCounts& more)
{
    for (const auto& [what, count] : more)
        sum[what] += count;
}

/// Counts and warns about bad data: once for each object and reason, as long as the process lives.
class ConversionReport
{
public:
    void count(const std::string& what, uint64_t number = 1) { _counts[what] += number; }
    void add(const ConversionCounts& counts) { addCounts(_counts, counts); }

    /// Counts one skipped or changed object and names it: "transform 'root/arm': singular,
    /// skipped".
    void warn(const std::string& what, const std::string& object, const std::string& message);

    const ConversionCounts& counts() const { return _counts; }

private:
    ConversionCounts _counts;
};

/// Says what was left out of a geometry, in one line for each reason.
void warnAboutGeometry(const std::string& path, const ConversionCounts& counts);

} // namespace osgRayTrace::engine
