// ConversionReport.cpp - wording of the conversion's warnings. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/ConversionReport.h"

#include "osgRayTrace/bridge/WarnOnce.h"

namespace osgRayTrace::engine
{

namespace
{

struct Wording
{
    const char* what;
    const char* message;
};

constexpr Wording kGeometryWordings[] = {
    {"skipped.index-out-of-range", "triangles with an index beyond the vertex array, skipped"},
    {"skipped.not-finite", "triangles with a vertex that is NaN, infinite or out of range, skipped"},
    {"skipped.deprecated-data",
     "per-primitive bindings or array indices: call fixDeprecatedData, skipped"},
    {"skipped.vertex-type", "vertex array of an unknown type, skipped"},
    {"repaired.normal", "normals that are zero, missing or not finite, replaced by face normals"},
    {"warned.opposite-normals", "triangles whose normals look to their back, lit by the side seen"},
    {"repaired.color", "colours that are missing or not finite, replaced by white"},
    {"repaired.texture-coordinate",
     "texture coordinates that are missing or not finite, replaced by 0"},
};

} // namespace

void ConversionReport::warn(const std::string& what, const std::string& object,
                            const std::string& message)
{
    count(what);
    warnOnce(object + ": " + message);
}

void warnAboutGeometry(const std::string& path, const ConversionCounts& counts)
{
    for (const Wording& wording : kGeometryWordings)
    {
        const auto found = counts.find(wording.what);
        if (found == counts.end()) continue;
        warnOnce("geometry '" + path + "': " + std::to_string(found->second) + " " +
                 wording.message);
    }
}

} // namespace osgRayTrace::engine
