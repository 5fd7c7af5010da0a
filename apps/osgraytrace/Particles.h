// Particles.h - whether a scene has particles, which depend on all times before. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/LibraryName.h"

#include <osg/NodeVisitor>

namespace osgRayTrace::app
{

/// Looks for anything of osgParticle.
class ParticleFinder : public osg::NodeVisitor
{
public:
    ParticleFinder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override
    {
        found = found || engine::isFrom(&node, "osgParticle");
        if (!found) traverse(node);
    }

    bool found = false;
};

inline bool hasParticles(osg::Node& scene)
{
    ParticleFinder finder;
    scene.accept(finder);
    return finder.found;
}

} // namespace osgRayTrace::app
