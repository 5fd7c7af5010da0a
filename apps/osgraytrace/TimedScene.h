// TimedScene.h - a scene that goes with the time, and the view of its beginning. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "SceneClock.h"
#include "apps/common/PlacedCamera.h"

#include <osg/Node>

namespace osgRayTrace::app
{

struct Options;

struct TimedScene
{
    TimedScene(const Options& options, const osg::ref_ptr<osg::Node>& timed);

    osg::ref_ptr<osg::Node> scene;
    SceneClock clock;
    Placement home; ///< of the first frame: the view does not follow the scene's size
};

} // namespace osgRayTrace::app
