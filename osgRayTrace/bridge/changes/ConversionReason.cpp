// ConversionReason.cpp - the words for each reason. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/ConversionReason.h"

namespace osgRayTrace::engine
{

const char* textOf(ConversionCause cause)
{
    switch (cause)
    {
    case ConversionCause::None:
        return "";
    case ConversionCause::Dirty:
        return "dirtyScene() was called";
    case ConversionCause::Picking:
        return "a pick needs an index of what is traced";
    case ConversionCause::OtherRoot:
        return "the scene has another root";
    case ConversionCause::OtherConditions:
        return "the viewer's light, background colour or traversal mask has changed";
    case ConversionCause::OtherSettings:
        return "a setting has changed that decides on materials or lights";
    case ConversionCause::OtherOrigin:
        return "the eye has gone too far from the origin of the engine's coordinates";
    case ConversionCause::FailedBefore:
        return "the last conversion failed, or the graph was released";
    case ConversionCause::NotPatchable:
        return "the scene has clip planes, or lengths for which its unit was chosen";
    case ConversionCause::NoStaticBvh:
        return "so much has moved that the static BVH is given up";
    case ConversionCause::NotWatched:
        return "the last look for changes was interrupted";
    case ConversionCause::FirstNode:
        return "the first visible node of the scene is another one";
    case ConversionCause::InheritedState:
        return "state above the scene has changed";
    case ConversionCause::TooManyNodes:
        return "the graph has more nodes than are watched";
    case ConversionCause::ManyEdits:
        return "more than 256 nodes came or went at once";
    case ConversionCause::SharedNode:
        return "a node that is on several paths has changed, came or went";
    case ConversionCause::ChildOrder:
        return "children of a node are in another order";
    case ConversionCause::SpecialNode:
        return "a light, a node with a hint or one of a class that is not known came or went";
    case ConversionCause::Untracked:
        return "something has changed in or below a node of a class that is not known";
    case ConversionCause::UntrackedState:
        return "state has changed above a node of a class that is not known";
    case ConversionCause::Hint:
        return "a hint to trace or to rasterize has changed";
    case ConversionCause::ReferenceFrame:
        return "the reference frame of a transform or of a light source has changed, or a light "
               "source has lost or got its light";
    case ConversionCause::DrawingMode:
        return "the draw callback, the hint or the data variance of a drawable has changed";
    case ConversionCause::VertexAttributes:
        return "colours, texture coordinates or other vertex attributes have changed";
    case ConversionCause::MovedSpecial:
        return "a transform has moved a light or a node of a class that is not known";
    case ConversionCause::MaterialFile:
        return "state has changed or nodes came while a material file is set";
    case ConversionCause::OtherPaths:
        return "the paths to a geometry are not those of the last conversion";
    case ConversionCause::NotAlone:
        return "a geometry was converted for the place it is in: a polygon offset, clip planes, "
               "or a node of a class that is not known above it";
    case ConversionCause::NotAnInstance:
        return "a geometry is not traced, or not as instances of one mesh";
    case ConversionCause::StateEffects:
        return "state has changed that decides on more than the material";
    case ConversionCause::CurrentColor:
        return "the first or the last material came or went that sets the current colour";
    case ConversionCause::ColorRule:
        return "the first physical material came";
    case ConversionCause::LastOfState:
        return "the last surface went that had a physical material, a light model or a material "
               "that sets the current colour";
    case ConversionCause::AmbientLight:
        return "a light model with another ambient light came";
    case ConversionCause::ClipPlanes:
        return "something came that clip planes cut";
    case ConversionCause::LampShape:
        return "the shape of an area light has changed";
    case ConversionCause::LightReport:
        return "what the report says of the lights has changed";
    case ConversionCause::Reported:
        return "what the report says of a geometry has changed";
    case ConversionCause::SpecialSubgraph:
        return "what came has lights, paged files, parts that OSG draws, or something to report";
    case ConversionCause::LargeSubgraph:
        return "as much geometry came as the static BVH has";
    case ConversionCause::BadTransform:
        return "a transform is singular, projective or not finite";
    case ConversionCause::PlaceBound:
        return "something has moved whose texture coordinates are generated from its place";
    case ConversionCause::Winding:
        return "a transform has begun to mirror, or may have, where the side of a face matters";
    case ConversionCause::Lengths:
        return "coordinates are very large or very small, or far from their own origin";
    case ConversionCause::NoMesh:
        return "no mesh of a geometry is kept";
    case ConversionCause::LinesOrPoints:
        return "a geometry has deformed that has lines or points";
    }
    return "";
}

} // namespace osgRayTrace::engine
