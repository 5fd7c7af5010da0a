// CullPass.h - an application's own cull visitor, for cull traversals that draw nothing. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/FrameStamp>
#include <osg/View>
#include <osg/observer_ptr>
#include <osg/ref_ptr>
#include <osgUtil/CullVisitor>

#include <memory>

namespace osgRayTrace::engine
{

/// Holds a clone of a pass's cull visitor and what cull callbacks may ask of a pass. The clone
/// lives as long as its original is the visitor of the pass: nodes may keep data for each visitor.
struct CullPass
{
    osg::ref_ptr<osgUtil::CullVisitor> visitor; ///< clone
    osg::observer_ptr<osgUtil::CullVisitor> original;
    osg::observer_ptr<osg::Camera> camera;
    osg::observer_ptr<osg::View> view;
    osg::ref_ptr<osg::FrameStamp> frameStamp;
    bool isClone = false; ///< false: the visitor's class has no clone() of its own
};

/// Returns the pass of this visitor: the last one, if it is of the same visitor. Cull thread.
std::shared_ptr<CullPass> cullPass(osgUtil::CullVisitor& visitor, std::shared_ptr<CullPass> last);

} // namespace osgRayTrace::engine
