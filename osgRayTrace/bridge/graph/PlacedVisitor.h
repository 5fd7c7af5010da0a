// PlacedVisitor.h - a visitor that answers the questions of nodes as the view of a conversion
// would. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ReferenceView.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"

#include <osg/Matrixd>
#include <osg/NodeVisitor>

#include <vector>

namespace osgRayTrace::engine
{

/// Knows where in the world it is. Levels of detail and nodes that turn to the view ask it for the
/// values below, which are in the local coordinates of the node that asks.
class PlacedVisitor : public osg::NodeVisitor
{
public:
    osg::CullStack* asCullStack() override { return _cullStack.at(_worldFromLocal.back()); }
    const osg::CullStack* asCullStack() const override
    {
        return _cullStack.at(_worldFromLocal.back());
    }
    osg::Vec3 getEyePoint() const override;
    float getDistanceToEyePoint(const osg::Vec3& position, bool useLodScale) const override;
    float getDistanceFromEyePoint(const osg::Vec3& position, bool useLodScale) const override;
    float getDistanceToViewPoint(const osg::Vec3& position, bool useLodScale) const override;

protected:
    /// The input must live as long as the visitor.
    explicit PlacedVisitor(const ConversionInput& input);

    /// Moves to a place, or nearly if the matrix flattens things. Returns null, or what is wrong
    /// with the matrix, a key of ConversionCounts: then it stays where it is.
    const char* enterPlace(const osg::Matrixd& worldFromLocal);

    /// Returns the world matrix below a transform at the place.
    osg::Matrixd worldBelow(const osg::Transform& node);

    const ConversionInput& _input;
    std::vector<osg::Matrixd> _worldFromLocal; ///< stack of places, never empty

private:
    ReferenceCullStack _cullStack;
};

} // namespace osgRayTrace::engine
