// CullCapture.h - what a cull traversal would draw of a subtree. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/CullPass.h"
#include "osgRayTrace/bridge/common/ReferenceView.h"
#include "osgRayTrace/bridge/graph/CullRecord.h"

#include <osg/Matrixd>
#include <osg/NodeVisitor>
#include <osg/Viewport>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

namespace osgRayTrace::engine
{

/// Runs the application's own cull visitor over nodes without culling anything, and reads what it
/// would draw. Lights and other positioned state go nowhere. Nothing is paged in. Nodes and
/// callbacks of the application's run: they may change what is below them.
class CullCapture
{
public:
    /// The pass and the view must live as long as this object.
    CullCapture(CullPass& pass, const ReferenceView& view, unsigned int traversalMask);

    /// Captures the last node of a path, which is below worldFromParent, into a record. Returns
    /// CullRecord::take().
    bool node(const osg::NodePath& path, const osg::Matrixd& worldFromParent, CullRecord& record,
              const CullRecord::SameState& sameState = {});

    /// Captures what plain traversals meet directly below the last node of the path, in the state
    /// that the node's class has in OSG and in the place worldFromNode: without what the node
    /// itself does in cull.
    CullRecord below(const osg::NodePath& path, const osg::Matrixd& worldFromNode);

private:
    template <class Visit>
    bool run(const osg::NodePath& path, const osg::Matrixd& worldFromParent, const Visit& visit,
             CullRecord& record, const CullRecord::SameState& sameState);

    CullPass& _pass;
    const ReferenceView& _view;
    const unsigned int _traversalMask;
    const osg::ref_ptr<osg::RefMatrix> _projection, _viewFromWorld;
    const osg::ref_ptr<osg::Viewport> _viewport;
    const osg::ref_ptr<osgUtil::RenderStage> _stage; ///< empty between captures, as is the graph
    const osg::ref_ptr<osgUtil::StateGraph> _graph;
};

/// Returns whether the calling thread captures: a RayTracedScene on the way is then a plain group.
bool isCapturing();

} // namespace osgRayTrace::engine
