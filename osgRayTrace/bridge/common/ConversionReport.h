// ConversionReport.h - counts, places and warnings of a conversion. Layer: bridge.
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

/// Counts objects by "<class>.<reason>", as Statistics::conversion tells them:
/// - converted: parts of the Scene, namely geometry (drawables), instance, material, texture and
///   light; the viewer's own light is a headlight or a sky-light
/// - traced: parts that are traced with the material that a rule gives them
/// - repaired: values that were replaced, namely normal, texture-coordinate, color (each a vertex),
///   environment-not-finite, -negative, -too-bright (each a pixel), environment-scale
/// - skipped: bad data left out, namely index-out-of-range, not-finite, degenerate (each a
///   triangle); all other reasons count objects
/// - warned: things that are traced as they are, and may not be what was meant, namely far-vertices
///   (a drawable), opposite-normals (a triangle), and trace-hint for a node that is hinted to be
///   traced but cannot be
/// - approximated: things that are traced, but not with all that OpenGL would do (a drawable or an
///   object)
/// - unused: things that have no effect in OpenGL either, such as light-replaced: a light that the
///   next one of its number replaces
/// - not-traced: things that have no triangles, or that do not belong to the scene as a ray sees
///   it; OSG draws them if there is a viewer
/// - rasterized: things that have triangles but that OSG draws nevertheless, in a viewer
/// - traced: uses of what OSG draws, traced for all rays but the camera's
/// - missing: files that could not be read, by their purpose; paths are "FILE" or "FILE, for NODE
///   PATH"
using ConversionCounts = std::map<std::string, uint64_t>;

inline void addCounts(ConversionCounts& sum, const ConversionCounts& more)
{
    for (const auto& [what, count] : more)
        sum[what] += count;
}

/// Holds the node paths of the first few objects by the keys of ConversionCounts.
using ConversionPaths = std::map<std::string, std::vector<std::string>>;

constexpr std::size_t kPathsKept = 4;

/// Counts bad data. The log gets the first object of a reason, and a line that there are more.
class ConversionReport
{
public:
    using Place = std::function<std::string()>;

    /// Sets the place of the objects that are counted from now on. The place is asked for with the
    /// first few objects of each reason only, so it may be slow. Empty: no place. Objects that the
    /// function refers to must live until the next call.
    void setPlace(Place place) { _place = std::move(place); }

    /// Tells the function of each count from now on. It must live until the next call; empty: none.
    using Listener = std::function<void(const std::string& what, uint64_t number)>;
    void setListener(Listener listener) { _listener = std::move(listener); }

    void count(const std::string& what, uint64_t number = 1);
    void add(const ConversionCounts& counts);
    void add(const ConversionReport& other); ///< adds the paths as well

    /// Counts one object by the cause, such as "rule 'glass'", which is named with the first place.
    void countFor(const std::string& what, const std::string& cause);

    /// Counts a skipped or changed object, names the first: "transform 'root/arm': singular,
    /// skipped".
    void warn(const std::string& what, const std::string& object, const std::string& message);

    /// Counts a file that could not be read, names the first: "texture wall.png: the file cannot be
    /// read, " and the substitute.
    void missing(const std::string& what, const std::string& file, const std::string& object,
                 const std::string& instead);

    /// Adds counts that belong to the present place, with the files that are missing for it.
    void addHere(const ConversionReport& other);

    const ConversionCounts& counts() const { return _counts; }

    /// Returns how often something was counted, apart from the counts of converted parts.
    uint64_t remarks() const { return _remarks; }
    const ConversionPaths& paths() const { return _paths; }

    /// Returns whether warn has named the first object of this reason.
    bool isNamed(const std::string& what) const { return _named.count(what) > 0; }

private:
    void recordPath(const std::string& what, const std::string& path);

    ConversionCounts _counts;
    ConversionPaths _paths;
    uint64_t _remarks = 0;
    std::set<std::string> _named;
    Place _place;
    Listener _listener;
};

/// Warns about the omissions of a geometry, if it is the first one of a reason.
void warnAboutGeometry(const std::string& path, const ConversionCounts& counts);

/// Names each reason why something does not look as OpenGL shows it, once in the life of the
/// process, with the first object. Reasons whose first object has its line are left out.
/// rasterizesRest: parts that are not traced are drawn by OSG, and not worth a warning.
void warnOnceAReason(const ConversionReport& report, bool rasterizesRest);

} // namespace osgRayTrace::engine
