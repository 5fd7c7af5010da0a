// RasterizedPicker.cpp - leads osgUtil's visitor to the parts that are not ray traced. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/pick/RasterizedPicker.h"

#include <osg/Geode>
#include <osg/Transform>

#include <map>

namespace osgRayTrace::engine
{

namespace
{

using Segment = osgUtil::LineSegmentIntersector;

template <class Matrix> Matrix* copyOf(Matrix* matrix)
{
    return matrix ? new Matrix(*matrix) : nullptr;
}

/// Leads osgUtil's visitor from the decorator to the parts. Nodes that the next part's way shares
/// with the last one stay pushed, and are not visited again if the segment misses them.
class PartVisitor : public osgUtil::IntersectionVisitor
{
public:
    PartVisitor(osgUtil::IntersectionVisitor& at, Segment& segment, const NodeTree& paths)
        : osgUtil::IntersectionVisitor(&segment, at.getReadCallback()), _paths(paths)
    {
        setTraversalMask(at.getTraversalMask());
        setNodeMaskOverride(at.getNodeMaskOverride());
        setFrameStamp(const_cast<osg::FrameStamp*>(at.getFrameStamp()));
        setUseKdTreeWhenAvailable(at.getUseKdTreeWhenAvailable());
        setLODSelectionMode(at.getLODSelectionMode());
        setReferenceEyePoint(at.getReferenceEyePoint());
        setReferenceEyePointCoordinateFrame(at.getReferenceEyePointCoordinateFrame());
        if (at.getWindowMatrix()) pushWindowMatrix(copyOf(at.getWindowMatrix()));
        if (at.getProjectionMatrix()) pushProjectionMatrix(copyOf(at.getProjectionMatrix()));
        if (at.getViewMatrix()) pushViewMatrix(copyOf(at.getViewMatrix()));
        if (at.getModelMatrix()) pushModelMatrix(copyOf(at.getModelMatrix()));
        for (osg::Node* node : at.getNodePath())
            pushOntoNodePath(node);
        push_clone();
    }

    void visit(const PickIndex::Part& part)
    {
        _paths.way(part.path, _way);
        if (!descendTo(_way.size() - 1)) return;
        osg::Node& node = part.inPlace ? *part.inPlace : _paths.node(part.path);
        osg::Drawable* drawable = node.asDrawable();
        const bool inGeode = !_levels.empty() && _paths.node(_levels.back().entry).asGeode();
        if (drawable && inGeode)
            intersect(drawable); // geodes do not check their drawables' masks
        else
            node.accept(*this);
    }

private:
    struct Level
    {
        uint32_t entry = NodeTree::kNone;
        bool open = false; ///< false: the nodes below are masked out, or the segment misses them
    };

    /// Moves below the first depth nodes of the way. Returns false if the segment misses one of
    /// them.
    bool descendTo(std::size_t depth)
    {
        std::size_t common = 0;
        while (common < depth && common < _levels.size() && _levels[common].entry == _way[common])
            ++common;
        while (_levels.size() > common)
            ascend();
        while (_levels.size() < depth && isOpen())
            descend(_way[_levels.size()]);
        return isOpen();
    }

    bool isOpen() const { return _levels.empty() || _levels.back().open; }

    void descend(uint32_t entry)
    {
        osg::Node& node = _paths.node(entry);
        Level level;
        level.entry = entry;
        level.open = validNodeMask(node) && enter(node);
        _levels.push_back(level);
        if (!level.open) return;
        pushOntoNodePath(&node);
        const osg::Transform* transform = node.asTransform();
        if (!transform) return;
        osg::ref_ptr<osg::RefMatrix> matrix =
            getModelMatrix() ? copyOf(getModelMatrix()) : new osg::RefMatrix;
        transform->computeLocalToWorldMatrix(*matrix, this);
        pushModelMatrix(matrix.get());
        push_clone();
    }

    void ascend()
    {
        const Level level = _levels.back();
        _levels.pop_back();
        if (!level.open) return;
        osg::Node& node = _paths.node(level.entry);
        if (node.asTransform())
        {
            pop_clone();
            popModelMatrix();
        }
        popFromNodePath();
        leave();
    }

    const NodeTree& _paths;
    std::vector<Level> _levels;
    std::vector<uint32_t> _way;
};

} // namespace

std::vector<Segment::Intersection> pickRasterized(const PickIndex& index,
                                                  osgUtil::IntersectionVisitor& visitor,
                                                  const Segment& segment)
{
    std::vector<Segment::Intersection> hits;
    if (index.parts().empty()) return hits;
    const osg::ref_ptr<Segment> own =
        new Segment(segment.getCoordinateFrame(), segment.getStart(), segment.getEnd(), nullptr,
                    segment.getIntersectionLimit());
    own->setPrecisionHint(segment.getPrecisionHint());
    PartVisitor parts(visitor, *own, index.paths());
    // Originals of copies that lack the traced triangles.
    std::map<const osg::Node*, osg::Node*> originals;
    for (const PickIndex::Part& part : index.parts())
    {
        if (part.inPlace) originals[part.inPlace.get()] = &index.paths().node(part.path);
        parts.visit(part);
    }
    for (Segment::Intersection hit : own->getIntersections())
    {
        const auto original = originals.find(hit.drawable.get());
        if (original != originals.end())
        {
            if (hit.nodePath.back() == hit.drawable) hit.nodePath.back() = original->second;
            hit.drawable = original->second->asDrawable();
        }
        hits.push_back(std::move(hit));
    }
    return hits;
}

} // namespace osgRayTrace::engine
