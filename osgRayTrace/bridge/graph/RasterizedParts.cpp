// RasterizedParts.cpp - replays the way from the decorator to the parts that OSG draws. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/RasterizedParts.h"

#include "osgRayTrace/bridge/geometry/PointSolids.h"
#include "osgRayTrace/bridge/graph/PlacedState.h"

#include <osg/Transform>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

using Path = std::vector<osg::ref_ptr<osg::Node>>;

/// Moves the visitor down the paths. Parts come in the order of the traversal, so nodes that the
/// next part's path shares with the last one stay pushed.
class Descent
{
public:
    explicit Descent(osgUtil::CullVisitor& visitor) : _visitor(visitor) {}
    ~Descent() { ascend(0); }

    /// Moves below the nodes [begin, end) of a path. Returns false if one of them is masked out.
    bool moveTo(Path::const_iterator begin, Path::const_iterator end)
    {
        const auto length = static_cast<std::size_t>(end - begin);
        std::size_t common = 0;
        while (common < std::min(length, _nodes.size()) && _nodes[common] == begin[common])
            ++common;
        ascend(common);
        for (auto node = begin + static_cast<std::ptrdiff_t>(common); node != end; ++node)
        {
            if (!_visitor.validNodeMask(**node)) return false;
            descend(**node);
        }
        return true;
    }

private:
    void descend(osg::Node& node)
    {
        _visitor.pushOntoNodePath(&node);
        if (const osg::StateSet* stateSet = node.getStateSet()) _visitor.pushStateSet(stateSet);
        if (osg::Transform* transform = node.asTransform())
        {
            osg::ref_ptr<osg::RefMatrix> matrix =
                new osg::RefMatrix(*_visitor.getModelViewMatrix());
            transform->computeLocalToWorldMatrix(*matrix, &_visitor);
            _visitor.pushModelViewMatrix(matrix.get(), transform->getReferenceFrame());
        }
        _nodes.push_back(&node);
    }

    void ascend(std::size_t length)
    {
        for (; _nodes.size() > length; _nodes.pop_back())
        {
            osg::Node& node = *_nodes.back();
            if (node.asTransform()) _visitor.popModelViewMatrix();
            if (node.getStateSet()) _visitor.popStateSet();
            _visitor.popFromNodePath();
        }
    }

    osgUtil::CullVisitor& _visitor;
    std::vector<osg::Node*> _nodes;
};

/// Returns whether a part mixes with the traced picture. A colour mask leaves channels of the
/// picture beneath, and a logic operation combines with it; that picture is the traced one:
/// DisplayTexture draws it in bin 1. Whoever has chosen a bin has chosen an order.
bool mixesWithPicture(const RasterizedPart& part)
{
    bool masks = false;
    for (const osg::ref_ptr<osg::Node>& node : part.path)
    {
        const osg::StateSet* stateSet = node->getStateSet();
        if (!stateSet) continue;
        if (stateSet->useRenderBinDetails()) return false;
        masks = masks || stateSet->getAttribute(osg::StateAttribute::COLORMASK) ||
                stateSet->getAttribute(osg::StateAttribute::LOGICOP);
    }
    return masks;
}

/// Holds the place in the state graph of what one part has drawn.
struct DrawnPart
{
    const osgUtil::StateGraph* graph = nullptr;
    const TracedLeaves* traced = nullptr;
};

const TracedLeaves* tracedIn(const osgUtil::StateGraph* graph, const std::vector<DrawnPart>& drawn)
{
    for (; graph; graph = graph->_parent)
        for (const DrawnPart& part : drawn)
            if (part.graph == graph) return part.traced;
    return nullptr;
}

bool isTraced(const osg::Drawable& drawable, const TracedLeaves& traced)
{
    const bool made = drawable.getNumParents() == 0 && drawable.asGeometry();
    return made ? traced.made : traced.drawables.count(&drawable) > 0;
}

/// Takes out of a bin the leaves that are traced. Cameras below the parts have stages of their own,
/// which keep theirs. SceneView deletes state graphs without leaves before the bin is drawn, so the
/// bin must not name them.
void takeOut(osgUtil::RenderBin& bin, const std::vector<DrawnPart>& drawn)
{
    for (osgUtil::StateGraph* graph : bin.getStateGraphList())
    {
        const TracedLeaves* traced = tracedIn(graph, drawn);
        if (!traced) continue;
        osgUtil::StateGraph::LeafList& leaves = graph->_leaves;
        leaves.erase(std::remove_if(leaves.begin(), leaves.end(),
                                    [traced](const osg::ref_ptr<osgUtil::RenderLeaf>& leaf)
                                    { return isTraced(*leaf->getDrawable(), *traced); }),
                     leaves.end());
    }
    auto& graphs = bin.getStateGraphList();
    graphs.erase(std::remove_if(graphs.begin(), graphs.end(),
                                [](const osgUtil::StateGraph* graph)
                                { return graph->_leaves.empty(); }),
                 graphs.end());
    for (const auto& [number, inner] : bin.getRenderBinList())
        takeOut(*inner, drawn);
}

/// Returns the state set of bins after the picture. It is never freed, as threads may cull while
/// the process ends.
const osg::StateSet* stateAfterPicture()
{
    static const osg::StateSet* const stateSet = []
    {
        auto* after = new osg::StateSet;
        after->ref();
        after->setRenderBinDetails(2, "RenderBin");
        return after;
    }();
    return stateSet;
}

} // namespace

osg::ref_ptr<osg::Geometry> untracedSets(const osg::Geometry& geometry, float pointRadius)
{
    const bool solids = solidRadius(geometry, pointRadius) > 0.0f;
    osg::Geometry::PrimitiveSetList rest;
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
        if (!hasTriangles(*set) && !(solids && hasSolids(*set))) rest.push_back(set);
    if (rest.empty()) return nullptr;
    osg::ref_ptr<osg::Geometry> copy = new osg::Geometry(geometry);
    copy->setPrimitiveSetList(rest);
    copy->getBound(); // computed now, as several cull threads may ask for it at once
    return copy;
}

RasterizedPart rasterizedPart(RasterizedPart::Kind kind, const osg::NodePath& path)
{
    RasterizedPart part;
    part.kind = kind;
    constexpr std::ptrdiff_t kAbove = 2;
    if (path.size() > kAbove) part.path.assign(path.begin() + kAbove, path.end());
    return part;
}

void cullParts(const RasterizedParts& parts, osgUtil::CullVisitor& visitor)
{
    Descent descent(visitor);
    std::vector<DrawnPart> drawn;
    for (const RasterizedPart& part : parts)
    {
        if (part.kind == RasterizedPart::Pick) continue;
        if (part.path.empty()) continue; // without a decorator the path is empty
        osg::Node& node = *part.path.back();
        if (!descent.moveTo(part.path.begin(), part.path.end() - 1)) continue;
        if (part.kind != RasterizedPart::Draw)
        {
            if (visitor.validNodeMask(node)) placeState(node, visitor);
        }
        else
        {
            const bool after = mixesWithPicture(part);
            if (after) visitor.pushStateSet(stateAfterPicture());
            if (part.traced)
            {
                visitor.pushStateSet(part.traced->mark.get());
                visitor.getCurrentStateGraph()->setUserData(part.traced.get());
                drawn.push_back({visitor.getCurrentStateGraph(), part.traced.get()});
            }
            (part.inPlace ? *part.inPlace : node).accept(visitor);
            if (part.traced) visitor.popStateSet();
            if (after) visitor.popStateSet();
        }
    }
    if (!drawn.empty()) takeOut(*visitor.getCurrentRenderStage(), drawn);
}

} // namespace osgRayTrace::engine
