// GraphGenerator.h - scene graphs of random nodes, matrices, states, lights and geometries. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "FuzzSeeds.h"

#include <osg/Geometry>
#include <osg/Group>

#include <vector>

namespace osgRayTrace::test
{

struct RandomGraph
{
    osg::ref_ptr<osg::Group> root;
    std::vector<osg::ref_ptr<osg::Geometry>> geometries; ///< each once, however often it is used
    bool bounded = false; ///< OSG can compute the bounds of all geometries without harm
};

/// Returns a graph whose nodes are within about 3 of the origin, except those that are deliberately
/// not.
RandomGraph randomGraph(Dice& dice);

} // namespace osgRayTrace::test
