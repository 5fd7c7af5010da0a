// CullOutcome.h - what becomes of a subtree with a cull traversal of its own. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/HookAnswers.h"
#include "osgRayTrace/bridge/graph/CullRecord.h"

#include <osg/Node>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

constexpr uint32_t kNoCulledLeaf = 0xffffffffu;

/// Holds a leaf of a cull traversal and what becomes of it.
struct CulledLeaf : CapturedLeaf
{
    const char* left = nullptr; ///< why OSG draws it, a key of ConversionCounts; null: it is traced
    bool proxy = false;         ///< OSG draws it, and it has a proxy: see Proxies.h
    /// True: the drawable is of no node, and drawable is a copy of it, which stays the same object
    /// although the application may take turns with several.
    bool made = false;
    uint32_t number = kNoCulledLeaf; ///< see GeometryUse::culled

    /// Returns whether the leaf is a part of the traced scene.
    bool isInScene() const { return !left || proxy; }
};

/// Holds a decision on a node that may draw or push state in cull, see cullReason().
struct CullOutcome
{
    enum Kind
    {
        Plain,    ///< its cull traversal adds nothing: the subtree is walked like any other
        Captured, ///< the leaves of its cull traversal stand for the subtree
        Left      ///< it cannot be captured, and OSG draws all of it
    };

    Kind kind = Plain;
    osg::NodePath path;                        ///< from the root to the node
    std::vector<osg::ref_ptr<osg::Node>> kept; ///< nodes of path from below the decorator on
    std::vector<CulledLeaf> leaves;            ///< in the order of the traversal, if Captured
    CullRecord record;   ///< what the cull traversal has left to draw; of a conversion alone
    HookAnswers answers; ///< answers of the application's hook for the drawables

    bool otherStages = false; ///< see CullRecord

    /// Returns whether OSG has to draw something of the subtree.
    bool isDrawn() const;
};

/// Returns why a node may draw or push state in cull that no other traversal finds, as a key of
/// ConversionCounts: its class, or the class of a cull callback, is of no library of OSG's. Null:
/// it does not.
const char* cullReason(const osg::Node& node);

/// Returns whether nothing below a node has a hint against OSG drawing all of it.
bool isHintedAlike(const osg::Node& node);

} // namespace osgRayTrace::engine
