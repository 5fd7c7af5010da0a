// DrawableTriangles.h - the triangles of drawables that are no osg::Geometry, as geometries. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/graph/IsoSurfaces.h"
#include "osgRayTrace/bridge/graph/MediumBoxes.h"

#include <osg/Drawable>
#include <osg/Geometry>

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

namespace osgRayTrace::engine
{

/// Holds geometries of the triangles that drawables tell by osg::PrimitiveFunctor, and copies of
/// the geometries that nodes draw in cull. Each conversion and each patch begins a round, in which
/// the drawables are asked again; conversions alone end one. A geometry stays the same object, with
/// the same arrays while its values do.
class DrawableTriangles
{
public:
    void begin()
    {
        ++_round;
        isoSurfaces.begin();
        mediumBoxes.begin();
    }

    /// Returns the triangles; null: the drawable tells none. The pointer is valid until end().
    const osg::Geometry* of(const osg::Drawable& drawable);

    /// Returns a copy of the number-th geometry that a cull traversal finds at or below a node: of
    /// those that a drawable chooses, or that are of no node. The copy is the same object whichever
    /// geometry is chosen, because rigs of applications take turns with two. It has arrays of its
    /// own, as the application writes to its arrays at any time, and the name, the user data and
    /// the node mask of the geometry that is chosen now.
    osg::Geometry& chosen(const osg::Node& node, std::size_t number, const osg::Geometry& geometry);

    /// Forgets the drawables that were not asked for.
    void end();

    /// Forgets the drawables that nobody else holds. As end() does, it invalidates pointers to what
    /// they have become.
    void dropUnshared();

    /// Returns a hash of the triangles, for drawables that change without a sign; 0: the drawable
    /// tells none.
    static uint64_t hashOf(const osg::Drawable& drawable);

    // These have the rounds of this object.
    IsoSurfaces isoSurfaces; ///< of osgVolume's tiles
    MediumBoxes mediumBoxes;

private:
    struct Copy
    {
        osg::ref_ptr<const osg::Node> node;    ///< keeps the address unique
        osg::ref_ptr<osg::Geometry> triangles; ///< null: there are none
        uint64_t hash = 0;
        unsigned int used = 0;
    };

    std::map<const osg::Drawable*, Copy> _copies;
    std::map<std::pair<const osg::Node*, std::size_t>, Copy> _chosen; ///< by number, too
    unsigned int _round = 0;
};

} // namespace osgRayTrace::engine
