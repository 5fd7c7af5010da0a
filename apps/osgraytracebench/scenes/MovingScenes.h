// MovingScenes.h - a textured terrain and a town with traffic, for views that move. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osg/MatrixTransform>

#include <vector>

namespace osgRayTrace::bench
{

/// Returns a height field of 2 km a side with a texture of meadows, rocks and roads, under a sun.
osg::ref_ptr<osg::Group> texturedTerrain();

/// Holds a town of nine blocks with houses, whose streets have stripes, crossings and pavements as
/// coloured polygons, and a hundred cars of several parts with colours at their vertices, under a
/// sun. z is up; streets are at multiples of 100 m.
struct Traffic
{
    Traffic();

    /// Puts the cars where they are at a time [s].
    void move(double time);

    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<osg::ref_ptr<osg::MatrixTransform>> cars;
};

} // namespace osgRayTrace::bench
