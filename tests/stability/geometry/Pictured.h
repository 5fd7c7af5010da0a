// Pictured.h - a scene graph as a picture, and the messages about it. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/bridge/Graphs.h"
#include "tests/bridge/Messages.h"
#include "tests/stability/geometry/Compare.h"

#include <osg/LightSource>

#include <initializer_list>
#include <string>

namespace osgRayTrace::engine::test
{

/// Returns the nodes below a point light at (1, -3, 4).
inline osg::ref_ptr<osg::Group> lit(std::initializer_list<osg::ref_ptr<osg::Node>> nodes)
{
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->getLight()->setPosition({1.0f, -3.0f, 4.0f, 1.0f});
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(source);
    root->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    for (const osg::ref_ptr<osg::Node>& node : nodes)
        root->addChild(node);
    return root;
}

inline View obliqueView(int pixels = 96)
{
    return perspectiveView({1.5, -2.5, 2.0}, {0, 0, 0}, {0, 0, 1}, 35.0, pixels, pixels);
}

inline Picture pictureOf(const ConversionResult& converted, IntegratorKind kind)
{
    const auto traced = TracedScene::build(converted.scene, std::make_shared<Workers>());
    return render(traced, obliqueView(), optionsOf(kind), 16);
}

} // namespace osgRayTrace::engine::test
