// ConversionReason.h - why an edit makes the whole graph be converted again. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

#include <cstdint>
#include <string>

namespace osgRayTrace::engine
{

/// Each cause has its words in textOf().
enum class ConversionCause : uint8_t
{
    None, ///< only the edit was redone, or the first conversion
    // SceneUpdater and SceneConverter find these causes, which concern the whole scene:
    Dirty,
    Picking,
    OtherRoot,
    OtherConditions,
    OtherSettings,
    OtherOrigin,
    FailedBefore,
    NotPatchable,
    NoStaticBvh,
    // GraphWatch finds these causes:
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
    NodeMask,
    // ScenePatcher and PlacePatcher find these causes:
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
    CullTraversal,
    Enclosure,
};

constexpr ConversionCause kLastCause = ConversionCause::Enclosure;

/// Returns one clause, such as "children of a node are in another order"; it is empty for None.
const char* textOf(ConversionCause cause);

/// A reason is plain data: its only text is the path, which is made only if the graph is converted.
struct ConversionReason
{
    ConversionCause cause = ConversionCause::None;
    std::string path; ///< path of the edited node; empty: see geometry
    /// This geometry stands for the path, which GraphWatch::pathOf() finds. If it is null, the
    /// reason concerns no single node.
    const osg::Geometry* geometry = nullptr;
    uint32_t use = 0; ///< number of the path to geometry, see ChangedUse
};

} // namespace osgRayTrace::engine
