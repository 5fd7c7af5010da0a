// CullLeaves.h - the leaves that a cull traversal of a program's view draws. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/CullPass.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"

#include <osg/Drawable>
#include <osg/Matrixd>
#include <osgUtil/CullVisitor>

#include <functional>
#include <vector>

namespace osgRayTrace::test
{

struct Leaf
{
    osg::ref_ptr<const osg::Drawable> drawable;
    osg::Matrixd modelView;
    bool ownStage = false; ///< whether a camera below the view draws the leaf
};

using Leaves = std::vector<Leaf>;

/// Returns the leaves of a cull traversal of the visitor's pass without culling, which traverse()
/// runs.
Leaves leavesOf(const engine::CullPass& pass, const engine::ViewingConditions& conditions,
                const std::function<void(osgUtil::CullVisitor&)>& traverse);

} // namespace osgRayTrace::test
