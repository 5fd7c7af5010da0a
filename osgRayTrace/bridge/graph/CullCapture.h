// CullCapture.h - what a cull traversal would draw of a subtree. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/CullPass.h"
#include "osgRayTrace/bridge/common/ReferenceView.h"

#include <osg/Drawable>
#include <osg/Matrixd>
#include <osg/NodeVisitor>
#include <osg/StateSet>

#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a drawable as a cull traversal leaves it to draw.
struct CapturedLeaf
{
    osg::ref_ptr<osg::Drawable> drawable;
    osg::Matrixd worldFromLocal;
    /// State sets from the captured node on, the outermost first; the drawable's own is the last.
    std::vector<osg::ref_ptr<const osg::StateSet>> states;
    bool isProjected = false; ///< a node below the captured one gives it a projection of its own
};

struct CapturedContent
{
    std::vector<CapturedLeaf> leaves; ///< in the order of the traversal
    bool otherStages = false;         ///< true: cameras have drawn something of their own
    std::string error;                ///< message of an exception of the application's; empty: none
};

/// Runs the application's own cull visitor over nodes without culling anything, and reads what it
/// would draw. Lights and other positioned state go nowhere. Nothing is paged in. Nodes and
/// callbacks of the application's run: they may change what is below them.
class CullCapture
{
public:
    CullCapture(CullPass& pass, const ReferenceView& view, unsigned int traversalMask)
        : _pass(pass), _view(view), _traversalMask(traversalMask)
    {
    }

    /// Captures the last node of a path, which is below worldFromParent.
    CapturedContent node(const osg::NodePath& path, const osg::Matrixd& worldFromParent) const;

    /// Captures what plain traversals meet directly below the last node of the path, in the state
    /// that the node's class has in OSG and in the place worldFromNode: without what the node
    /// itself does in cull.
    CapturedContent below(const osg::NodePath& path, const osg::Matrixd& worldFromNode) const;

private:
    template <class Visit>
    CapturedContent run(const osg::NodePath& path, const osg::Matrixd& worldFromParent,
                        const Visit& visit) const;

    CullPass& _pass;
    const ReferenceView& _view;
    unsigned int _traversalMask;
};

/// Returns whether the calling thread captures: a RayTracedScene on the way is then a plain group.
bool isCapturing();

} // namespace osgRayTrace::engine
