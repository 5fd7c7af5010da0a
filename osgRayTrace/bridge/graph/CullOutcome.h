// CullOutcome.h - what becomes of a subtree with a cull traversal of its own. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/HookAnswers.h"
#include "osgRayTrace/bridge/graph/CullCapture.h"

#include <osg/Node>

#include <cstdint>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a decision on a node that may draw or push state in cull, see cullReason().
struct CullOutcome
{
    enum Kind
    {
        Plain,    ///< its cull traversal adds nothing: the subtree is walked like any other
        Captured, ///< the leaves of its cull traversal stand for the subtree
        Left      ///< it cannot be captured, and OSG draws all of it
    };

    /// Holds a drawable that OSG goes on drawing.
    struct LeftLeaf
    {
        osg::ref_ptr<osg::Drawable> drawable;
        const char* reason = nullptr; ///< key of ConversionCounts
    };

    Kind kind = Plain;
    osg::NodePath path;                        ///< from the root to the node
    std::vector<osg::ref_ptr<osg::Node>> kept; ///< nodes of path from below the decorator on
    std::vector<CapturedLeaf> traced;
    std::vector<LeftLeaf> left;
    bool otherStages = false; ///< see CapturedContent
    std::size_t captured = 0; ///< number of leaves of the cull traversal
    uint64_t signature = 0;   ///< hash of the drawables and state sets of those leaves
    std::string error;        ///< see CapturedContent
    HookAnswers answers;      ///< answers of the application's hook for the drawables

    /// Returns whether OSG has to draw something of the subtree.
    bool isDrawn() const { return kind == Left || !left.empty() || otherStages; }
};

/// Returns why a node may draw or push state in cull that no other traversal finds, as a key of
/// ConversionCounts: its class, or the class of a cull callback, is of no library of OSG's. Null:
/// it does not.
const char* cullReason(const osg::Node& node);

/// Returns whether nothing below a node has a hint against OSG drawing all of it.
bool isHintedAlike(const osg::Node& node);

/// Returns whether two matrices are equal but for the rounding of a way through another view.
bool sameMatrix(const osg::Matrixd& a, const osg::Matrixd& b, double eyeDistance);

} // namespace osgRayTrace::engine
