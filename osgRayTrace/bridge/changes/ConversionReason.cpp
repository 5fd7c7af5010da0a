// ConversionReason.cpp - the words for each reason. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/ConversionReason.h"

#include <cstddef>
#include <iterator>

namespace osgRayTrace::engine
{

namespace
{

struct CauseText
{
    ConversionCause cause;
    const char* text;
};

/// The texts stand in the order of the enumerators.
constexpr CauseText kTexts[] = {
    {ConversionCause::None, ""},
    {ConversionCause::Dirty, "dirtyScene() was called"},
    {ConversionCause::Picking, "a pick needs an index of what is traced"},
    {ConversionCause::OtherRoot, "the scene has another root"},
    {ConversionCause::OtherConditions,
     "the number or the place of the viewer's light has changed, or a traversal mask"},
    {ConversionCause::OtherSettings, "a setting has changed that decides on materials or lights"},
    {ConversionCause::OtherOrigin,
     "the eye has gone too far from the origin of the engine's coordinates"},
    {ConversionCause::FailedBefore, "the last conversion failed, or the graph was released"},
    {ConversionCause::NotPatchable, "the scene has lengths for which its unit was chosen"},
    {ConversionCause::NoStaticBvh, "so much has moved that the static BVH is given up"},
    {ConversionCause::NotWatched, "the last look for changes was interrupted"},
    {ConversionCause::FirstNode, "the first visible node of the scene is another one"},
    {ConversionCause::InheritedState, "state above the scene has changed"},
    {ConversionCause::TooManyNodes, "the graph has more nodes than are watched"},
    {ConversionCause::ManyEdits, "more than 256 nodes came or went at once"},
    {ConversionCause::SharedNode, "a node that is on several paths has changed, came or went"},
    {ConversionCause::ChildOrder, "children of a node are in another order"},
    {ConversionCause::SpecialNode,
     "a light, a node with a hint or one of a class that is not known came or went"},
    {ConversionCause::Untracked,
     "something has changed in or below a node of a class that is not known"},
    {ConversionCause::UntrackedState,
     "state has changed above a node of a class that is not known"},
    {ConversionCause::Hint, "a hint to trace or to rasterize has changed"},
    {ConversionCause::ReferenceFrame,
     "the reference frame of a transform or of a light source has changed, or a light "
     "source has lost or got its light"},
    {ConversionCause::DrawingMode,
     "the draw callback, the hint or the data variance of a drawable has changed"},
    {ConversionCause::VertexAttributes,
     "colours, texture coordinates or other vertex attributes have changed"},
    {ConversionCause::MovedSpecial,
     "a transform has moved a light or a node of a class that is not known"},
    {ConversionCause::NodeMask, "a node mask hides other nodes than before from some of the views"},
    {ConversionCause::MaterialFile, "state has changed or nodes came while a material file is set"},
    {ConversionCause::OtherPaths, "the paths to a geometry are not those of the last conversion"},
    {ConversionCause::NotAlone, "a geometry was converted for the place it is in: a polygon offset "
                                "of one of several uses, clip "
                                "planes, or a node of a class that is not known above it"},
    {ConversionCause::NotAnInstance, "a geometry is not traced, or not as instances of one mesh"},
    {ConversionCause::StateEffects, "state has changed that decides on more than the material"},
    {ConversionCause::CurrentColor,
     "the first or the last material came or went that sets the current colour"},
    {ConversionCause::ColorRule, "the first physical material came"},
    {ConversionCause::LastOfState,
     "the last surface went that had a physical material, a light model or a material "
     "that sets the current colour"},
    {ConversionCause::AmbientLight, "a light model with another ambient light came"},
    {ConversionCause::ClipPlanes,
     "something came that clip planes cut, or came or went because they moved"},
    {ConversionCause::LampShape, "the shape of an area light has changed"},
    {ConversionCause::LightReport, "what the report says of the lights has changed"},
    {ConversionCause::Reported, "what the report says of a geometry has changed"},
    {ConversionCause::SpecialSubgraph,
     "what came has lights, paged files, parts that OSG draws, or something to report"},
    {ConversionCause::LargeSubgraph, "as much geometry came as the static BVH has"},
    {ConversionCause::BadTransform, "a transform is singular, projective or not finite"},
    {ConversionCause::PlaceBound,
     "something has moved whose texture coordinates are generated from its place"},
    {ConversionCause::Winding,
     "a transform has begun to mirror, or may have, where the side of a face matters"},
    {ConversionCause::Lengths,
     "coordinates are very large or very small, or far from their own origin"},
    {ConversionCause::NoMesh, "no mesh of a geometry is kept"},
    {ConversionCause::LinesOrPoints, "a geometry has deformed that has lines or points"},
    {ConversionCause::CullTraversal,
     "a cull traversal of the application's shows something else, or something came below one"},
    {ConversionCause::Enclosure,
     "something has left what enclosed the scene, or nothing is outside of it any more"},
};

constexpr bool isInOrder()
{
    for (std::size_t i = 0; i < std::size(kTexts); ++i)
        if (static_cast<std::size_t>(kTexts[i].cause) != i) return false;
    return std::size(kTexts) == static_cast<std::size_t>(kLastCause) + 1;
}
static_assert(isInOrder(), "each cause has its words, in the order of the enumerators");

} // namespace

const char* textOf(ConversionCause cause)
{
    return kTexts[static_cast<std::size_t>(cause)].text;
}

} // namespace osgRayTrace::engine
