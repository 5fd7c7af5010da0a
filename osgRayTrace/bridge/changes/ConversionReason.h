// ConversionReason.h - why an edit makes the whole graph be converted again. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

#include <cstdint>
#include <string>

namespace osgRayTrace::engine
{

/// Each has its words in textOf().
enum class ConversionCause : uint8_t
{
    None, ///< an edit was redone alone, or there was no scene before
    // Of the whole scene, by SceneUpdater and SceneConverter:
    Dirty,
    Picking,
    OtherRoot,
    OtherConditions,
    OtherSettings,
    OtherOrigin,
    FailedBefore,
    NotPatchable,
    NoStaticBvh,
    // Found by GraphWatch:
    NotWatched,
    FirstNode,
    InheritedState,
    TooManyNodes,
    ManyEdits,
    SharedNode,
    ChildOrder,
    SpecialNode,
    Untracked,
    UntrackedState,
    Hint,
    ReferenceFrame,
    DrawingMode,
    VertexAttributes,
    MovedSpecial,
    // Found by ScenePatcher and PlacePatcher:
    MaterialFile,
    OtherPaths,
    NotAlone,
    NotAnInstance,
    StateEffects,
    CurrentColor,
    ColorRule,
    LastOfState,
    AmbientLight,
    ClipPlanes,
    LampShape,
    LightReport,
    Reported,
    SpecialSubgraph,
    LargeSubgraph,
    BadTransform,
    PlaceBound,
    Winding,
    Lengths,
    NoMesh,
    LinesOrPoints,
};

constexpr ConversionCause kLastCause = ConversionCause::LinesOrPoints;

/// One clause: "children of a node are in another order". Of None: an empty one.
const char* textOf(ConversionCause cause);

/// Plain data: no text is made but the path, and that only if the graph is converted.
struct ConversionReason
{
    ConversionCause cause = ConversionCause::None;
    std::string path; ///< of the node that was edited; empty: see geometry
    /// Instead of a path, which GraphWatch::pathOf() finds. Null: the reason is no single node's.
    const osg::Geometry* geometry = nullptr;
    uint32_t use = 0; ///< number of the path to geometry, see ChangedUse
};

} // namespace osgRayTrace::engine
